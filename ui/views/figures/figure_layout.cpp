// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/figure_layout.h"

#include "ui/look/palette.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

// At scale 1.
constexpr double kFreeHeight = 205;  ///< of the axes, where the height is free
constexpr double kMargin = 10;

bool has_few_windows(const Figure& figure) {
  for (const Chart& chart : figure.charts)
    for (const Curve& curve : chart.curves)
      for (const int count : curve.counts)
        if (count > 0 && count < kFewWindows) return true;
  return false;
}

}  // namespace

ChartStyle paper_style(const FigureSheet& sheet) {
  const double s = sheet.scale;
  const FigureType& type = sheet.type;
  return {.ground = 0xFFFFFF,
          .text = palette::kInk,
          .tick_text = palette::kInk,
          .dim = palette::kPaperAxis,
          .axis = palette::kPaperAxis,
          .grid = palette::kPaperGrid,
          .scale = s,
          .text_size = type.axis_title,
          .tick_size = type.tick,
          .x_spacing = 3.6 * type.tick,
          .y_spacing = 2.2 * type.tick,
          .legend = {40 * s, 8 * s, 26 * s, 1.7 * type.legend, type.legend}};
}

FigureLayout lay_out(const Figure& figure,
                     const std::vector<CurveStyle>& styles,
                     const FigureSheet& sheet) {
  const double s = sheet.scale;
  const FigureType& type = sheet.type;
  FigureLayout layout;
  layout.width = sheet.width;
  const double room = sheet.width - 2 * kMargin * s;
  layout.title = wrapped(figure.title, type.title, true, room);
  layout.note = wrapped(figure.note, type.note, false, room);
  const double lines = kLineSpacing * type.title * static_cast<double>(layout.title.size());
  layout.title_y = kMargin * s + kLineSpacing * type.title / 2;
  const double top = kMargin * s + lines;
  for (const CurveStyle& style : styles) layout.keys.push_back({&style, style.name});
  if (has_few_windows(figure))
    layout.keys.push_back({nullptr, fmt::format("fewer than {} windows", kFewWindows)});
  const double legend_height = place_keys(layout.keys, paper_style(sheet).legend, room, 0.5);
  const double note_height = kLineSpacing * type.note * static_cast<double>(layout.note.size());
  const double below = legend_height + note_height + (layout.note.empty() ? 1 : 1.6) * kMargin * s;
  const auto charts = static_cast<int>(figure.charts.size());
  const int columns = std::clamp(sheet.columns, 1, std::max(1, charts));
  const int rows = std::max(1, (charts + columns - 1) / columns);
  const double head = 2.1 * type.chart_title;
  const double foot = 0.5 * type.tick + 8 * s + type.tick + 2.2 * type.axis_title;
  double height = kFreeHeight * s;
  if (sheet.height) height = std::max(20 * s, (*sheet.height - top - below) / rows - head - foot);
  const double left = 3.3 * type.tick + 2 * type.axis_title, right = 1.3 * type.tick;
  const double column = sheet.width / columns;
  for (int i = 0; i < charts; ++i) {
    const int row = i / columns;
    layout.axes.emplace_back(std::round(column * (i % columns) + left),
                             std::round(top + head + (head + height + foot) * row),
                             std::max(20 * s, std::round(column - left - right)),
                             std::round(height));
  }
  const double end = top + rows * (head + height + foot);
  for (LegendKey& key : layout.keys) key.at += Eigen::Vector2d(kMargin * s, end);
  layout.note_y = end + legend_height + 0.6 * kMargin * s + kLineSpacing * type.note / 2;
  layout.height = sheet.height.value_or(std::ceil(end + below));
  return layout;
}

}  // namespace gpo
