// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/compare/compare_column.h"
#include "ui/views/overlay/view_options.h"

#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

struct ImDrawList;

namespace gpo {

class ImageTexture;

/// Finished inspections of one window of one recording, a method or setting each.
using Comparison = std::span<const std::shared_ptr<const Inspection>>;

/// Heading, picture and caption of one column.
struct ColumnPlace {
  ScreenRect heading, image, caption;
};

/// Width / height of its pictures, within what a column can show well; 4:3 where it is not known.
double aspect_of(const Camera& camera);

/// Of `count` columns, in so many rows that pictures of this aspect (width / height) are largest;
/// at the size of the current font.
std::vector<ColumnPlace> compare_places(const ScreenRect& rect,
                                        int count,
                                        double aspect,
                                        bool top_line);

/// The part of the picture that all columns show, whose pictures are as large as `image_size`
/// [screen px].
ImageZoom compare_zoom(std::span<const CompareColumn> columns,
                         const Recording& recording,
                         int frame,
                         const Eigen::Vector2d& image_size,
                         const ViewOptions& options);

/// One column each: heading in the method's color, the picture of frame `frame` (counts in the
/// recording), the same part in all columns, with that method's cube and thin and gray the true
/// one; below it what the result is worth and how it differs from the first, or why there is none.
/// `image` is null, or empty, where the recording has no pictures.
void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       std::span<const CompareColumn> columns,
                       const Recording& recording,
                       int frame,
                       ImageTexture* image,
                       const ViewOptions& options);

/// The same of inspections alone.
void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       Comparison inspections,
                       int frame,
                       ImageTexture* image);

/// What the colors of the cubes mean, from the left. Returns how wide it is [px].
double draw_cube_legend(ImDrawList& list, const Eigen::Vector2d& at, bool truth);

/// At which a column is 480 pixels wide.
cv::Size default_compare_size(Comparison inspections);
cv::Size default_compare_size(int columns, const Recording& recording);

/// Of the text, such that it fits into columns of this picture [-]; 1 at the default size.
double compare_text_scale(Comparison inspections, cv::Size size);

}  // namespace gpo
