// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace gpo {

/// How a chart's axis is divided: its range, and the values that are marked within.
struct AxisTicks {
  double low = 0, high = 1;
  std::vector<double> values;
  std::vector<std::string> labels;  ///< as many as values
};

/// At least three, else at most about `most` ticks at multiples of 1, 2 or 5 times a power of ten,
/// over [low, high], which is not extended. One value is given some room on both sides.
AxisTicks linear_ticks(double low, double high, int most);

/// Extends to 1, 2 or 5 times a power of ten below `low` and above `high`, both > 0. Ticks there,
/// or at powers of ten only where these are enough, or at some of them where they are too many, or
/// where they are fewer than three at round numbers between.
AxisTicks logarithmic_ticks(double low, double high, int most);

}  // namespace gpo
