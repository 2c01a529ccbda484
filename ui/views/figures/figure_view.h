// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/figure.h"
#include "ui/views/figures/drawing.h"

#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// Wide enough for its charts side by side.
cv::Size default_figure_size(const Figure& figure);

/// The figure on white: its charts side by side, one legend and the note below. Curves with markers
/// and dashes besides colors, hollow where few windows stand behind a point; bands between
/// quartiles translucent, outlined where they are many; bounds dotted; where there is nothing to
/// draw it says so. A unit is a pixel.
Drawing figure_drawing(const Figure& figure, cv::Size size);

/// The same for a page: so wide, as high as it takes, its charts side by side or one below the
/// other, with type of 7 pt and more.
Drawing printed_figure(const Figure& figure, double width_mm);

/// `figure_drawing` in pixels, CV_8UC3, BGR.
cv::Mat draw_figure(const Figure& figure, cv::Size size);

/// As SVG, with the names of what is shown in title and description.
std::string figure_svg(const Figure& figure, const Drawing& drawing);

}  // namespace gpo
