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
  std::string name;                            ///< in the legend
  std::uint32_t rgb = 0;                       ///< 0xRRGGBB
  bool dotted = false;                         ///< for a bound
  std::vector<double> x = {}, y = {};          ///< same length, x ascending
  std::vector<double> lower = {}, upper = {};  ///< the band, as long as y; empty: none
  std::vector<int> counts = {};    ///< values behind each point, as long as y; empty if unknown
  std::optional<int> marker = {};  ///< index of the marker in print; nullopt: the next one
};

struct Chart {
  std::string title;
  std::string x_label;       ///< with its unit
  std::string y_label;       ///< with its unit
  bool logarithmic = false;  ///< the y axis
  std::vector<Curve> curves = {};
};

/// Charts side by side with one legend.
struct Figure {
  std::string name;  ///< name of its files, without extension
  std::string title;
  std::vector<Chart> charts = {};
  std::string note = {};  ///< below the legend, about anything but the methods' curves
};

/// Points with fewer windows have no meaningful quartiles and are drawn hollow.
constexpr int kFewWindows = 4;

}  // namespace gpo
