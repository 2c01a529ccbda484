// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/figure.h"
#include "ui/views/charts/curve_style.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// Sizes of a figure's type [units].
struct FigureType {
  double title = 19, chart_title = 16, axis_title = 15, tick = 14, legend = 15, note = 13;
};

/// What a figure is to be fitted into [units].
struct FigureSheet {
  double width = 0;
  std::optional<double> height;  ///< nothing: what its parts take
  double scale = 1;              ///< of lines, markers and gaps
  int columns = 1;               ///< of charts
  FigureType type{};
};

/// A sample in the legend: of a curve, or what hollow points are.
struct LegendKey {
  const CurveStyle* style = nullptr;  ///< null: of hollow points
  std::string text;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< the sample's left end; the text is beside
};

/// Where the parts of a figure are, y down [units].
struct FigureLayout {
  double width = 0, height = 0, scale = 1;
  FigureType type{};
  std::vector<cv::Rect2d> axes;  ///< one a chart
  std::vector<std::string> title, note;
  double title_y = 0, note_y = 0;  ///< of the first line
  std::vector<LegendKey> keys;
};

constexpr double kSampleLength = 40, kLineSpacing = 1.35;

/// `styles` are pointed to.
FigureLayout lay_out(const Figure& figure,
                     const std::vector<CurveStyle>& styles,
                     const FigureSheet& sheet);

/// Whether points of the figure stand for fewer than `kFewWindows`.
bool has_few_windows(const Figure& figure);

}  // namespace gpo
