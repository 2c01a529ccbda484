// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/chart.h"

#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// Wide enough for its charts side by side; text as large as a paper needs.
cv::Size default_figure_size(const Figure& figure);

/// The figure on white, for print, without a display: its charts side by side, one legend below.
/// Curves with markers or dashes besides colors, bands between quartiles translucent, bounds
/// dotted; where there is nothing to draw it says so. CV_8UC3, BGR; on the same machine the same
/// bytes every time. Throws InputError where there is no OpenGL.
cv::Mat draw_figure(const Figure& figure, cv::Size size);

/// The same figure as SVG: text as outlines, the names of what is shown in title and description.
std::string figure_svg(const Figure& figure, cv::Size size);

}  // namespace gpo
