// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/chart.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkContext2D;
class vtkRectf;

namespace gpo {

enum class Dash { solid, dashed, dash_dot, dotted };

// Sizes at scale 1 [px].
constexpr double kCurveWidth_px = 2, kMarkerSize_px = 9, kHollow_px = 5;
constexpr double kDotSize_px = 3.2, kDotSpacing_px = 6.5;  ///< of Dash::dotted

/// How the curves of one name are drawn in all charts of a figure, and explained in its legend.
struct CurveStyle {
  std::string name;
  std::uint32_t rgb = 0;  ///< on paper dark enough for white
  Dash dash = Dash::solid;
  int marker = 0;       ///< vtkPlotPoints' marker; 0: none
  bool hollow = false;  ///< the marker
  double marker_px = kMarkerSize_px;
};

/// Of Dash::dashed and dash_dot: dashes and gaps in turn [px].
std::vector<double> dash_lengths(Dash dash, double scale);

/// One a name, in the order in which they appear. Markers differ, then dashes: a figure can be read
/// without its colors.
std::vector<CurveStyle> curve_styles(const Figure& figure);

/// A piece of the curve, as wide as the rectangle, in its middle.
void paint_sample(vtkContext2D& painter,
                  const CurveStyle& style,
                  const vtkRectf& rect,
                  double scale);

}  // namespace gpo
