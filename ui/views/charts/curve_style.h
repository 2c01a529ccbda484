// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

// Sizes at scale 1 [px].
constexpr double kCurveWidth_px = 2, kMarkerSize_px = 9;
constexpr double kBandOpacity = 0.18;
constexpr double kDotSize_px = 3.2, kDotSpacing_px = 6.5;  ///< for dotted curves

/// Style of the curves of one name, in all charts and the legend of a figure.
struct CurveStyle {
  std::string name;
  std::uint32_t rgb = 0;
  bool dotted = false;
  std::vector<double> dashes = {};           ///< and gaps in turn, at scale 1 [px]; empty: solid
  std::optional<int> marker = std::nullopt;  ///< index for `marker_shape`; on the screen a circle
  double marker_px = kMarkerSize_px;
};

/// Returns styles for print, one per name. Curves with the same marker have different dashes; a
/// color similar to an earlier one is replaced.
std::vector<CurveStyle> curve_styles(const Figure& figure);

/// Returns the CIE 1976 difference of two colors: 2 is barely visible, 100 is black on white.
double color_difference(std::uint32_t a, std::uint32_t b);

/// Returns the outline of a marker around a point; all have about the same visual weight.
std::vector<Eigen::Vector2d> marker_shape(int index, const Eigen::Vector2d& center, double size);

}  // namespace gpo
