// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/charts/cairo_drawing.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Range and marked values of an axis.
struct AxisTicks {
  double low = 0, high = 1;
  std::vector<double> values;
  std::vector<std::string> labels;  ///< one per value
};

/// Returns at least three, about `most` ticks at multiples of 1, 2 or 5 times a power of ten. A
/// range of one value is extended to both sides.
AxisTicks linear_ticks(double low, double high, int most);

/// Extends the range, > 0, to 1, 2 or 5 times a power of ten. Ticks are at such numbers, only at
/// (some) powers of ten if that is enough, at linear steps if there would be fewer than three.
AxisTicks logarithmic_ticks(double low, double high, int most);

/// Maps values of a chart to its image or to the screen.
struct ChartMapping {
  bool logarithmic = false;  ///< the y axis
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  double left = 0, bottom = 0;  ///< intersection of the axes [px]
  double width = 1;             ///< length of the x axis [px]
  double height = 1;            ///< length of the y axis [px]; negative if y points down

  double x_px(double value) const { return left + width * (value - x_low) / (x_high - x_low); }
  double y_px(double value) const {
    const double part = logarithmic ? std::log(value / y_low) / std::log(y_high / y_low)
                                    : (value - y_low) / (y_high - y_low);
    return bottom + height * part;
  }
  Eigen::Vector2d px(double x, double y) const { return {x_px(x), y_px(y)}; }
  double x_value(double px) const { return x_low + (x_high - x_low) * (px - left) / width; }
  double y_value(double px) const {
    const double part = (px - bottom) / height;
    return logarithmic ? y_low * std::pow(y_high / y_low, part) : y_low + (y_high - y_low) * part;
  }
  bool inside(const Eigen::Vector2d& point_px) const {
    const double u = (point_px.x() - left) / width, v = (point_px.y() - bottom) / height;
    return u >= 0 && u <= 1 && v >= 0 && v <= 1;
  }
};

/// Style of the curves of one name, in all charts and the legend of a figure.
struct CurveStyle {
  std::string name;
  std::uint32_t rgb = 0;
  bool dotted = false;
  std::vector<double> dashes = {};           ///< and gaps in turn, at scale 1 [px]; empty: solid
  std::optional<int> marker = std::nullopt;  ///< index for `marker_shape`; on the screen a circle
  double marker_px = 9;                      ///< at scale 1
};

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
