// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gpo {

/// A result of the window that is shown, and how it is told from the others.
struct ShownResult {
  std::string name;  ///< for people: "GPO without RANSAC"
  std::uint32_t rgb = 0;
  std::shared_ptr<const Inspection> inspection;
  bool current = false;  ///< the one that the whole window shows
};

/// The current result first, then the compared ones in the same window that are computed by now.
/// Empty where nothing is inspected yet.
std::vector<ShownResult> shown_results(const WorkbenchState& state);

}  // namespace gpo
