// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"

#include <string>
#include <vector>

namespace gpo {

/// Charts that stand side by side and share one legend.
struct Figure {
  std::string name;  ///< of its files, without extension
  std::string title;
  std::vector<Chart> charts;
  std::string note = {};  ///< below the legend: what is not a method's curve
};

/// Points of fewer windows have no quartiles to speak of, and are drawn as such.
constexpr int kFewWindows = 4;

}  // namespace gpo
