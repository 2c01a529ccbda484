// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/inspection/inspection.h"

#include <memory>
#include <string>

namespace gpo {

/// A configuration, and what came of it.
struct CompareColumn {
  Configuration configuration;
  std::shared_ptr<const Inspection> inspection;  ///< null: not there
  std::string missing;                           ///< what stands in its place: "computing"
};

}  // namespace gpo
