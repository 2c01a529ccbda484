// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/figure_view.h"

#include "ui/look/palette.h"
#include "ui/views/figures/chart_drawing.h"
#include "ui/views/figures/figure_layout.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

// Of one chart with its titles [px], at which text has its nominal size.
constexpr int kChartWidth = 500, kChartHeight = 440;

int chart_count(const Figure& figure) {
  return std::max(1, static_cast<int>(figure.charts.size()));
}

void draw_lines(Drawing& drawing,
                const std::vector<std::string>& lines,
                double y,
                double size,
                bool bold,
                std::uint32_t rgb) {
  for (const std::string& line : lines) {
    drawing.items.emplace_back(
        Text{line, {drawing.width / 2, y}, size, bold, Anchor::middle, false, rgb});
    y += kLineSpacing * size;
  }
}

void draw_key(Drawing& drawing, const LegendKey& key, const FigureLayout& layout) {
  const double s = layout.scale;
  const Vector2d beside = key.at + Vector2d((kSampleLength + 8) * s, 0);
  if (key.style != nullptr) {
    draw_sample(drawing, *key.style, key.at, s);
  } else {
    const Vector2d middle = key.at + Vector2d(kSampleLength * s / 2, 0);
    draw_marker(drawing, 0, middle, kMarkerSize_px * s, palette::kPaperAxis, true);
  }
  drawing.items.emplace_back(
      Text{key.text, beside, layout.type.legend, false, Anchor::begin, false, palette::kInk});
}

Drawing draw(const Figure& figure, const FigureSheet& sheet) {
  const std::vector<CurveStyle> styles = curve_styles(figure);
  const FigureLayout layout = lay_out(figure, styles, sheet);
  Drawing drawing{.width = layout.width, .height = layout.height, .items = {}};
  const FigureType& type = layout.type;
  draw_lines(drawing, layout.title, layout.title_y, type.title, true, palette::kInk);
  for (std::size_t i = 0; i < figure.charts.size(); ++i)
    draw_chart(drawing, figure.charts[i], styles, layout.axes[i], type, layout.scale);
  for (const LegendKey& key : layout.keys) draw_key(drawing, key, layout);
  draw_lines(drawing, layout.note, layout.note_y, type.note, false, palette::kPaperAxis);
  if (figure.charts.empty())
    draw_lines(drawing, {"no charts"}, layout.height / 2, type.title, false, palette::kInk);
  return drawing;
}

std::string description(const Figure& figure) {
  std::string text;
  for (const Chart& chart : figure.charts) {
    text += fmt::format("{} ({} over {}):", chart.title, chart.y_label, chart.x_label);
    for (const Curve& curve : chart.curves) text += fmt::format(" {};", curve.name);
    text += '\n';
  }
  return text + figure.note;
}

}  // namespace

cv::Size default_figure_size(const Figure& figure) {
  return {chart_count(figure) * kChartWidth, kChartHeight + 40};
}

Drawing figure_drawing(const Figure& figure, cv::Size size) {
  const int columns = chart_count(figure);
  const double s = std::clamp(
      std::min(1.0 * size.width / (columns * kChartWidth), 1.0 * size.height / kChartHeight),
      0.5,
      8.0);
  FigureType type;
  for (double* one :
       {&type.title, &type.chart_title, &type.axis_title, &type.tick, &type.legend, &type.note})
    *one *= s;
  return draw(figure, {1.0 * size.width, 1.0 * size.height, s, columns, type});
}

Drawing printed_figure(const Figure& figure, double width_mm) {
  constexpr double kUnit_mm = 25.4 / 72 / 2;  // half a point: 14 units are type of 7 pt
  constexpr double kNarrowest = 300;          // of a chart
  const double width = width_mm / kUnit_mm;
  const int columns = std::clamp(static_cast<int>(width / kNarrowest), 1, chart_count(figure));
  Drawing drawing = draw(figure, {width, std::nullopt, 1, columns, {16, 15, 14.5, 14, 14, 14}});
  drawing.unit_mm = kUnit_mm;
  return drawing;
}

cv::Mat draw_figure(const Figure& figure, cv::Size size) {
  return picture_of(figure_drawing(figure, size), 1);
}

std::string figure_svg(const Figure& figure, const Drawing& drawing) {
  return svg_of(drawing, figure.title, description(figure));
}

}  // namespace gpo
