// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/charts/chart_drawing.h"

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// Sizes of a figure's type [units].
struct FigureType {
  double title = 19, chart_title = 16, axis_title = 15, tick = 14, legend = 15, note = 13;
};

/// What a figure is to be fitted into [units].
struct FigureSheet {
  double width = 0;
  std::optional<double> height = {};  ///< nullopt: what its parts take
  double scale = 1;                   ///< of lines, markers and gaps
  int columns = 1;                    ///< of charts
  FigureType type = {};
  double unit_mm = 25.4 / 96;  ///< on paper; by default a unit is a pixel of 96 dpi
};

/// Where the parts of a figure are, y down [units].
struct FigureLayout {
  double width = 0, height = 0;
  std::vector<cv::Rect2d> axes;  ///< one a chart
  std::vector<std::string> title, note;
  double title_y = 0, note_y = 0;  ///< of the first line
  std::vector<LegendKey> keys;
};

constexpr double kLineSpacing = 1.35;

/// Colors and sizes of charts on white paper.
ChartStyle paper_style(const FigureSheet& sheet);

/// `styles` are pointed to.
FigureLayout lay_out(const Figure& figure,
                     const std::vector<CurveStyle>& styles,
                     const FigureSheet& sheet);

}  // namespace gpo
