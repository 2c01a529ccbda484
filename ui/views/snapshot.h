// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/views/image/image_view.h"

namespace gpo {

// Views of a frame without a display: CV_8UC3, BGR, reproducible. Throw InputError without OpenGL.

/// By default of the size of the recording's images.
cv::Mat snapshot_image(const Inspection& inspection,
                       int frame,
                       std::optional<cv::Size> size = {},
                       const ViewOptions& options = {});

cv::Mat snapshot_scene(const Inspection& inspection,
                       int frame,
                       std::optional<cv::Size> size = {},
                       const ViewOptions& options = {},
                       Theme theme = Theme::dark);

/// The disc of normals, after a study of the window.
cv::Mat snapshot_normals(const std::shared_ptr<const Inspection>& inspection,
                         int frame,
                         std::optional<cv::Size> size = {},
                         Theme theme = Theme::dark);

/// Finished inspections of one window of one recording, by different methods or settings.
using Comparison = std::span<const std::shared_ptr<const Inspection>>;

/// By default of the size of `default_compare_size`.
cv::Mat snapshot_compare(Comparison inspections, int frame, std::optional<cv::Size> size = {});

/// Result of comparing two images. llvmpipe's results differ by a few levels between processors, in
/// all of the image; a displaced item differs by many, in one place.
struct ImageComparison {
  static constexpr std::array<int, 4> kSweep = {1, 3, 8, 30};

  bool equal = false;
  std::string reason;      ///< why unequal, for people
  int unequal = 0;         ///< pixels with a channel that differs by more than the tolerance
  double worst_block = 0;  ///< largest share of unequal pixels in a block of 16 x 16 [0..1]
  std::array<int, 4> beyond = {};  ///< numbers of pixels that differ by more than kSweep
  cv::Mat difference;              ///< CV_8UC3: differences, enhanced, over the expected image
};

/// Compares two images, CV_8UC3. A pixel is unequal if a channel differs by more than `tolerance`
/// levels. Images are unequal if their sizes differ, or more than 0.05 % of their pixels, or more
/// than 25 % of the pixels of a block of 16 x 16.
ImageComparison compare_images(const cv::Mat& actual, const cv::Mat& expected, int tolerance = 3);

}  // namespace gpo
