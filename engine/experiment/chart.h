// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gpo {

/// A line, or points of a distribution with the band between its quartiles. NaN leaves a gap.
struct Curve {
  std::string name;                  ///< in the legend
  std::uint32_t rgb = 0;             ///< 0xRRGGBB
  bool dotted = false;               ///< a bound, not a result
  std::vector<double> x, y;          ///< same length, x ascending
  std::vector<double> lower, upper;  ///< the band; as long as y, or empty: none
};

struct Chart {
  std::string title;
  std::string x_label;       ///< with its unit
  std::string y_label;       ///< with its unit
  bool logarithmic = false;  ///< the y axis
  std::vector<Curve> curves;
};

/// Charts that stand side by side and share one legend. What is drawn; `ui/views` draws it.
struct Figure {
  std::string name;  ///< of its files, without extension
  std::string title;
  std::vector<Chart> charts;
};

}  // namespace gpo
