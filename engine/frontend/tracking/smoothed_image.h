// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace gpo {

constexpr int kSmoothedGain = 64;  ///< value of one gray level in a smoothed image

/// Smooths an image by (1 6 1)/8 along both axes (a standard deviation of 0.5 px) so that it can be
/// interpolated: CV_16UC1. `gray` is CV_8UC1.
cv::Mat smooth_image(const cv::Mat& gray);

/// Returns the image at half the size: each pixel is the mean of four. CV_16UC1, as `image`.
cv::Mat halved(const cv::Mat& image);

}  // namespace gpo
