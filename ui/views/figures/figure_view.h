// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/charts/charts.h"

#include <optional>

namespace gpo {

/// Returns one style per name: equal markers differ in dashes, similar colors are replaced.
std::vector<CurveStyle> curve_styles(const Figure& figure);

/// Returns the CIE 1976 difference of two colors: 2 is barely visible, 100 is black on white.
double color_difference(std::uint32_t a, std::uint32_t b);

/// Sizes of a figure's text [units].
struct FigureType {
  double title = 19, chart_title = 16, axis_title = 15, tick = 14, legend = 15, note = 13;
};

/// The sheet of a figure [units].
struct FigureSheet {
  double width = 0;
  std::optional<double> height = {};  ///< nullopt: as high as the content
  double scale = 1;                   ///< for lines, markers and gaps
  int columns = 1;                    ///< charts per row
  FigureType type = {};
  double unit_mm = 25.4 / 96;  ///< on paper; by default a unit is a pixel of 96 dpi
};

/// Places of a figure's parts, y down [units].
struct FigureLayout {
  double width = 0, height = 0;
  std::vector<cv::Rect2d> axes;  ///< one per chart
  std::vector<std::string> title, note;
  double title_y = 0, note_y = 0;  ///< middle of the first line
  std::vector<LegendKey> keys;     ///< they point to the styles
};
FigureLayout lay_out(const Figure& figure,
                     const std::vector<CurveStyle>& styles,
                     const FigureSheet& sheet);

cv::Size default_figure_size(const Figure& figure);

/// Returns a sheet of pixels: charts side by side, one legend and the note below.
FigureSheet screen_sheet(const Figure& figure, cv::Size size);

/// Returns a sheet for a page, as high as its content, with text of at least 7 pt.
FigureSheet printed_sheet(const Figure& figure, double width_mm);

// Figures are white. Curves differ in markers and dashes besides colors; points of few windows are
// hollow, many bands are outlined, bounds are dotted. The same figure gives the same bytes.

/// Returns pixels, CV_8UC3, BGR.
cv::Mat figure_image(const Figure& figure, const FigureSheet& sheet, double px_per_unit = 1);

/// Returns SVG with text as outlines; its title and description name the content.
std::string figure_svg(const Figure& figure, const FigureSheet& sheet);

/// Returns a page of PDF with selectable text and its fonts.
std::string figure_pdf(const Figure& figure, const FigureSheet& sheet);

/// Draws the figure on a `screen_sheet`.
cv::Mat draw_figure(const Figure& figure, cv::Size size);

}  // namespace gpo
