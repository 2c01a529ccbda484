// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "ui/views/image/image_view.h"

struct ImDrawList;

namespace gpo {

using CompareColumns = std::span<const Compared>;

struct ColumnPlace {
  ScreenRect heading, image, caption;
};

struct CompareFrame {
  const Recording& recording;
  int frame;            ///< counted in the recording
  ImageTexture* image;  ///< null, or empty, if the recording has no images
  const ViewOptions& options;
};

/// Returns width / height of the images, limited to what a column can show well; 4:3 if unknown.
double aspect_of(const Recording& recording);

/// Arranges columns in the number of rows that makes images of this aspect largest.
std::vector<ColumnPlace> compare_places(const ScreenRect& rect,
                                        int count,
                                        double aspect,
                                        bool top_line);

/// Returns the part of the image that all columns show, of size `image_size` on the screen.
ImageZoom compare_zoom(CompareColumns columns,
                       const CompareFrame& shown,
                       const Vector2d& image_size);

/// Draws of each column heading, image with both cubes, and errors, or why there is no result.
void draw_compare_view(const Area& area, CompareColumns columns, const CompareFrame& shown);

/// Draws the meaning of the cubes' colors, from `at` to the right. Returns its width [px].
double draw_cube_legend(ImDrawList& list, const Vector2d& at, bool truth);

/// Returns the size with columns of 480 pixels.
cv::Size default_compare_size(int columns, const Recording& recording);

}  // namespace gpo
