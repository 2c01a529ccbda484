// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

constexpr int kSmoothedGain = 64;  ///< of a soft picture: 64 is one gray level

/// The picture smoothed by (1 6 1)/8 along both axes (a standard deviation of 0.5 px), so that it
/// may be read between its pixels: CV_16UC1. `gray` is CV_8UC1.
cv::Mat smoothed(const cv::Mat& gray);

/// Of half the size: each pixel is the mean of four. CV_16UC1 as `soft`.
cv::Mat halved(const cv::Mat& smoothed);

}  // namespace gpo
