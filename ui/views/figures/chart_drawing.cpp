// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/chart_drawing.h"

#include "ui/look/palette.h"
#include "ui/views/charts/axis_ticks.h"
#include "ui/views/charts/chart_mapping.h"
#include "ui/views/charts/chart_plots.h"
#include "ui/views/charts/chart_ticks.h"
#include "ui/views/charts/marker_shapes.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

/// Where more bands lie over each other, they are outlines.
constexpr int kMostFilledBands = 3;
constexpr double kOutlinedOpacity = 0.05, kOutlineOpacity = 0.6, kOutlineWidth = 0.8;
constexpr double kHollowShare = 0.55;  ///< of a hollow marker's size

/// A chart on its way to the drawing.
struct PrintedChart {
  Drawing& drawing;
  const Chart& chart;
  const std::vector<CurveStyle>& styles;
  cv::Rect2d axes;
  const FigureType& type;
  double scale;
  ChartMapping to;

  bool good(double x, double y) const {
    return std::isfinite(x) && std::isfinite(y) && (!chart.logarithmic || y > 0);
  }
  const CurveStyle& style_of(const Curve& curve) const {
    return *std::ranges::find(styles, curve.name, &CurveStyle::name);
  }
  void stroke(Path line, double width, const Ink& ink) const {
    drawing.items.emplace_back(Stroke{std::move(line), width * scale, ink});
  }
};

/// Whether so few windows stand behind a point that it has no quartiles to speak of.
bool is_few(const Curve& curve, std::size_t i) {
  return !curve.counts.empty() && curve.counts[i] < kFewWindows;
}

/// Without the quartiles of few windows.
Chart with_quartiles_of_many(Chart chart) {
  for (Curve& curve : chart.curves)
    for (auto* side : {&curve.lower, &curve.upper})
      for (std::size_t i = 0; i < side->size(); ++i)
        if (is_few(curve, i)) (*side)[i] = std::nan("");
  return chart;
}

/// What `good(i)` holds of, without gaps: [first, end).
template <class Good>
std::vector<std::pair<std::size_t, std::size_t>> spans_where(std::size_t count, const Good& good) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < count; ++i) {
    if (!good(i)) continue;
    if (found.empty() || found.back().second != i) found.emplace_back(i, i);
    found.back().second = i + 1;
  }
  return found;
}

void draw_band(const PrintedChart& plot, const Curve& curve, std::uint32_t rgb, bool filled) {
  if (curve.lower.empty()) return;
  const auto good = [&](std::size_t i) {
    return plot.good(curve.x[i], curve.lower[i]) && plot.good(curve.x[i], curve.upper[i]);
  };
  for (const auto& [first, end] : spans_where(curve.x.size(), good)) {
    Path below, above;
    for (std::size_t i = first; i < end; ++i) {
      below.push_back(plot.to.px(curve.x[i], curve.lower[i]));
      above.push_back(plot.to.px(curve.x[i], curve.upper[i]));
    }
    if (below.size() == 1) {
      plot.stroke({below[0], above[0]}, 1, {rgb});
      continue;
    }
    if (!filled)
      for (const Path& side : {below, above})
        plot.stroke(side, kOutlineWidth, {rgb, kOutlineOpacity});
    below.insert(below.end(), above.rbegin(), above.rend());
    plot.drawing.items.emplace_back(
        Fill{std::move(below), {rgb, filled ? kBandOpacity : kOutlinedOpacity}});
  }
}

void draw_line(Drawing& drawing, const Path& line, const CurveStyle& style, double s) {
  const double width = kCurveWidth_px * s;
  if (style.dotted) {
    for (const Vector2d& dot : points_along(line, kDotSpacing_px * s))
      drawing.items.emplace_back(Fill{marker_shape(0, dot, kDotSize_px * s), {style.rgb}});
    return;
  }
  if (line.size() < 2) return;
  if (style.dashes.empty()) {
    drawing.items.emplace_back(Stroke{line, width, {style.rgb}});
    return;
  }
  std::vector<double> pattern = style.dashes;
  for (double& length : pattern) length *= s;
  for (const auto& [from, to] : dashes_along(line, pattern))
    drawing.items.emplace_back(Stroke{{from, to}, width, {style.rgb}});
}

void draw_curve(const PrintedChart& plot, const Curve& curve) {
  const CurveStyle& style = plot.style_of(curve);
  const auto good = [&](std::size_t i) { return plot.good(curve.x[i], curve.y[i]); };
  for (const auto& [first, end] : spans_where(curve.x.size(), good)) {
    Path line;
    for (std::size_t i = first; i < end; ++i) line.push_back(plot.to.px(curve.x[i], curve.y[i]));
    draw_line(plot.drawing, line, style, plot.scale);
    if (!style.marker) continue;
    for (std::size_t i = first; i < end; ++i)
      draw_marker(plot.drawing,
                  *style.marker,
                  line[i - first],
                  style.marker_px * plot.scale,
                  style.rgb,
                  is_few(curve, i));
  }
}

void draw_axes(const PrintedChart& plot, const AxisTicks& x_ticks, const AxisTicks& y_ticks) {
  const double left = plot.axes.x, right = left + plot.axes.width, s = plot.scale;
  const double bottom = plot.axes.y + plot.axes.height, tick = 5 * s, size = plot.type.tick;
  const auto write = [&](const std::string& text, const Vector2d& at, Anchor anchor) {
    plot.drawing.items.emplace_back(Text{text, at, size, false, anchor, false, palette::kInk});
  };
  for (const double value : x_ticks.values) {
    const double x = plot.to.x_px(value);
    plot.stroke({{x, plot.axes.y}, {x, bottom}}, 1, {palette::kPaperGrid});
  }
  for (const double value : y_ticks.values) {
    const double y = plot.to.y_px(value);
    plot.stroke({{left, y}, {right, y}}, 1, {palette::kPaperGrid});
  }
  for (std::size_t i = 0; i < x_ticks.values.size(); ++i) {
    const double x = plot.to.x_px(x_ticks.values[i]);
    plot.stroke({{x, bottom}, {x, bottom + tick}}, 1, {palette::kPaperAxis});
    write(x_ticks.labels[i], {x, bottom + tick + 4 * s + size / 2}, Anchor::middle);
  }
  for (std::size_t i = 0; i < y_ticks.values.size(); ++i) {
    const double y = plot.to.y_px(y_ticks.values[i]);
    plot.stroke({{left - tick, y}, {left, y}}, 1, {palette::kPaperAxis});
    write(y_ticks.labels[i], {left - tick - 4 * s, y}, Anchor::end);
  }
  plot.stroke({{left, plot.axes.y}, {left, bottom}, {right, bottom}}, 1, {palette::kPaperAxis});
}

void draw_titles(const PrintedChart& plot) {
  const double x = plot.axes.x + plot.axes.width / 2, y = plot.axes.y + plot.axes.height / 2;
  const double bottom = plot.axes.y + plot.axes.height, size = plot.type.axis_title;
  const auto write = [&](Text text) {
    text.rgb = palette::kInk;
    plot.drawing.items.emplace_back(std::move(text));
  };
  write({plot.chart.title, {x, plot.axes.y - plot.type.chart_title}, plot.type.chart_title, true});
  write({plot.chart.x_label, {x, bottom + 9 * plot.scale + 1.1 * plot.type.tick + size}, size});
  Text upwards{plot.chart.y_label, {plot.axes.x - 3.3 * plot.type.tick - size, y}, size};
  upwards.upwards = true;
  write(std::move(upwards));
}

}  // namespace

void draw_marker(
    Drawing& drawing, int marker, const Vector2d& at, double size, std::uint32_t rgb, bool hollow) {
  drawing.items.emplace_back(Fill{marker_shape(marker, at, size), {rgb}});
  if (!hollow) return;
  drawing.items.emplace_back(Fill{marker_shape(marker, at, kHollowShare * size), {0xFFFFFF}});
}

void draw_sample(Drawing& drawing, const CurveStyle& style, const Vector2d& at, double scale) {
  draw_line(drawing, {at, at + Vector2d(kSampleLength * scale, 0)}, style, scale);
  if (!style.marker) return;
  const Vector2d middle = at + Vector2d(kSampleLength * scale / 2, 0);
  draw_marker(drawing, *style.marker, middle, style.marker_px * scale, style.rgb, false);
}

void draw_chart(Drawing& drawing,
                const Chart& whole,
                const std::vector<CurveStyle>& styles,
                const cv::Rect2d& axes,
                const FigureType& type,
                double scale) {
  const Chart chart = with_quartiles_of_many(whole);
  PrintedChart plot{drawing, chart, styles, axes, type, scale, {}};
  if (!has_values(chart)) {
    draw_axes(plot, {}, {});
    draw_titles(plot);
    const Vector2d middle(axes.x + axes.width / 2, axes.y + axes.height / 2);
    drawing.items.emplace_back(Text{
        "no values", middle, type.axis_title, false, Anchor::middle, false, palette::kPaperAxis});
    return;
  }
  const AxisTicks x = x_ticks(chart, axes.width, 3.6 * type.tick);
  const AxisTicks y = y_ticks(chart, axes.height, 2.2 * type.tick);
  plot.to = {chart.logarithmic,
             x.low,
             x.high,
             y.low,
             y.high,
             axes.x,
             axes.y + axes.height,
             axes.width,
             -axes.height};
  draw_axes(plot, x, y);
  draw_titles(plot);
  const auto bands =
      std::ranges::count_if(chart.curves, [](const Curve& c) { return !c.lower.empty(); });
  for (const Curve& curve : chart.curves)
    draw_band(plot, curve, plot.style_of(curve).rgb, bands <= kMostFilledBands);
  for (const bool bounds : {true, false})
    for (const Curve& curve : chart.curves)
      if (curve.dotted == bounds) draw_curve(plot, curve);
}

}  // namespace gpo
