// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

// Sizes at scale 1 [px].
constexpr double kCurveWidth_px = 2, kMarkerSize_px = 9;
constexpr double kBandOpacity = 0.18;
constexpr double kDotSize_px = 3.2, kDotSpacing_px = 6.5;  ///< of dotted curves

/// How the curves of one name are drawn in all charts of a figure, and explained in its legend.
struct CurveStyle {
  std::string name;
  std::uint32_t rgb = 0;  ///< on paper dark enough for white
  bool dotted = false;
  std::vector<double> dashes = {};           ///< and gaps in turn, at scale 1 [px]; empty: solid
  std::optional<int> marker = std::nullopt;  ///< of `marker_shape`; on the screen a circle
  double marker_px = kMarkerSize_px;
};

/// For print, one a name, in the order in which they appear. Curves with one marker differ in their
/// dashes: a figure can be read without its colors. No two colors look alike: of those that would,
/// the later one gets another.
std::vector<CurveStyle> curve_styles(const Figure& figure);

/// How different two colors look, as CIE 1976 has it: 2 is just seen, 100 is black on white.
double color_difference(std::uint32_t a, std::uint32_t b);

}  // namespace gpo
