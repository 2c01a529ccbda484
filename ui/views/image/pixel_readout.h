// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/zoom.h"

#include <string>

#include <Eigen/Core>
#include <opencv2/core.hpp>

struct ImDrawList;

namespace gpo {

/// "x 312.4  y 201.8 px   gray 137   2.31 d away on plane 2 (wall)   250 %": what is known of a
/// place in the picture; empty beside it. Pixels count from the middle of the first one. The plane
/// is that of the nearest track, within 5 % of the picture's width. `bgr`: CV_8UC3 of the frame,
/// may be empty. `scale`: screen pixels a pixel. `inspection` may be null.
std::string pixel_text(const Inspection* inspection,
                       int frame,
                       const Camera& camera,
                       const cv::Mat& bgr,
                       const Eigen::Vector2d& raw_px,
                       double scale);

/// Lines between pixels, where these are so large on the screen that they do not hide them.
void draw_pixel_grid(ImDrawList& list,
                     const ScreenRect& rect,
                     const ImageMapping& mapping,
                     const Camera& camera);

/// The text at the lower left corner.
void draw_pixel_text(ImDrawList& list, const ScreenRect& rect, const std::string& text);

}  // namespace gpo
