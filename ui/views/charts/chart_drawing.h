// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/charts/axis_ticks.h"
#include "ui/views/charts/cairo_drawing.h"
#include "ui/views/charts/curve_style.h"

namespace gpo {

/// Sizes of a legend [units].
struct LegendStyle {
  double sample = 40, beside = 8,
         between = 26;  ///< widths: a sample, the gaps after it and its text
  double row = 25.5, text_size = 15;
};

/// Style of a chart, in the window or on paper [units].
struct ChartStyle {
  std::uint32_t ground, text, tick_text, dim, axis, grid;
  double scale = 1;                       ///< for lines, markers and gaps
  double text_size = 15, tick_size = 14;  ///< em sizes
  double x_spacing = 50, y_spacing = 31;  ///< smallest distances of ticks
  bool dashes_coinciding = false;         ///< dashes a curve over an equal one, to show both
  LegendStyle legend = {};
};

/// Draws grid, bands, curves, axes and ticks with their labels, without titles; `axes` is the
/// rectangle between the axes' ends, `styles` has one entry per name. Returns the mapping of
/// values.
ChartMapping draw_chart(cairo_t& cairo,
                        const Chart& chart,
                        const std::vector<CurveStyle>& styles,
                        const cv::Rect2d& axes,
                        const ChartStyle& look);

/// An entry of a legend: a sample of a curve, or a hollow point, and its meaning.
struct LegendKey {
  const CurveStyle* style = nullptr;  ///< null: a hollow point
  std::string text;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< the sample's left end; the text is beside it
};

double width_of(const std::vector<LegendKey>& keys, const LegendStyle& look);

/// Places entries in rows no wider than `room`, the first of which begins at (0, 0). `align`: 0
/// left, 0.5 centered, 1 right. Returns the rows' height.
double place_keys(std::vector<LegendKey>& keys, const LegendStyle& look, double room, double align);

void draw_key(cairo_t& cairo, const LegendKey& key, const ChartStyle& look);

}  // namespace gpo
