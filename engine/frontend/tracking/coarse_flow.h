// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// Smoothed images (smoothed_image.h), each of half the size of the one before.
using SmoothedPyramid = std::vector<cv::Mat>;

/// `gray` is CV_8UC1.
SmoothedPyramid smoothed_pyramid(const cv::Mat& gray);

/// Estimates the motion of places from one image to the next [px]: from coarse to fine down to half
/// the size, invariant to gain and offset of the exposure. Accurate to a few tenths of a pixel; a
/// guess in areas without texture. `raw_px` is 2 x n, finite.
Eigen::Matrix2Xd coarse_flow(const SmoothedPyramid& from,
                             const SmoothedPyramid& to,
                             const Eigen::Matrix2Xd& raw_px);

}  // namespace gpo
