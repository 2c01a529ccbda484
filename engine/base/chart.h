// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
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
  std::vector<int> counts = {};      ///< values behind each point; as long as y, or empty: not told
  std::optional<int> marker = {};    ///< which of the markers for print; nothing: the next one
};

struct Chart {
  std::string title;
  std::string x_label;       ///< with its unit
  std::string y_label;       ///< with its unit
  bool logarithmic = false;  ///< the y axis
  std::vector<Curve> curves;
};

}  // namespace gpo
