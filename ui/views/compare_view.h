// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/image_geometry.h"

#include <memory>
#include <span>

#include <opencv2/core.hpp>

struct ImDrawList;

namespace gpo {

class PictureTexture;

/// Finished inspections of one window of one recording, a method or setting each.
using Comparison = std::span<const std::shared_ptr<const Inspection>>;

/// One column each, at most four side by side: heading in the method's color, the picture of frame
/// `frame` (counts in the recording) around the cubes, the same part in all columns, with that
/// method's cube and thin and gray the true one; below it what the result is worth, or why there is
/// none. `picture` is null, or empty, where the recording has no pictures.
void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       Comparison inspections,
                       int frame,
                       PictureTexture* picture);

/// At which a column is 480 pixels wide.
cv::Size default_compare_size(Comparison inspections);

/// Of the text, such that it fits into columns of this picture [-]; 1 at the default size.
double compare_text_scale(Comparison inspections, cv::Size size);

}  // namespace gpo
