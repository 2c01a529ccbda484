// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/figures/figure_layout.h"

#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// Wide enough for the figure's charts side by side [px].
cv::Size default_figure_size(const Figure& figure);

/// A sheet of pixels: charts side by side, one legend and the note below.
FigureSheet screen_sheet(const Figure& figure, cv::Size size);

/// A sheet for a page, as high as the figure takes: charts side by side or one below the other,
/// type of 7 pt and more.
FigureSheet printed_sheet(const Figure& figure, double width_mm);

// The figure on white. Curves differ in markers and dashes besides colors and are hollow at points
// of few windows; bands between quartiles are translucent, or outlined where they are many; bounds
// are dotted. The same figure gives the same bytes.

/// Pixels, CV_8UC3, BGR.
cv::Mat figure_image(const Figure& figure, const FigureSheet& sheet, double px_per_unit = 1);

/// SVG with text as outlines, so that it needs no font; the names of what is shown are in its title
/// and description.
std::string figure_svg(const Figure& figure, const FigureSheet& sheet);

/// A page of PDF with text that can be selected, and its fonts.
std::string figure_pdf(const Figure& figure, const FigureSheet& sheet);

/// Draws the figure on a `screen_sheet`.
cv::Mat draw_figure(const Figure& figure, cv::Size size);

}  // namespace gpo
