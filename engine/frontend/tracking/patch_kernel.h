// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/patch.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// Sums over a look's pixels of a picture's brightness I, where a warp puts them.
struct PatchSums {
  /// Of I times each of the look's columns (look.h).
  Eigen::Matrix<float, 8, 1> products = Eigen::Matrix<float, 8, 1>::Zero();
  float squares = 0;  ///< sum of I^2
};

/// One pass over a look whose pixels are all in the soft picture, bilinear between that picture's
/// own, as wide as this processor is. (OpenCV's `remap` rounds places to 1/32 px.)
PatchSums patch_sums(const cv::Mat& smoothed, const Patch& patch, const Warp& warp);

/// The same where the warp only shifts, of a look whose rows are whole multiples of the kernel's
/// width; without the products of dx and dy.
PatchSums shifted_sums(const cv::Mat& smoothed, const Patch& patch, const Eigen::Vector2d& center);

/// The versions that they choose from.
PatchSums patch_sums_baseline(const cv::Mat& smoothed, const Patch& patch, const Warp& warp);
PatchSums shifted_sums_baseline(const cv::Mat& smoothed,
                               const Patch& patch,
                               const Eigen::Vector2d& center);
/// Only where `has_avx2_fma` (engine/base/processor.h).
PatchSums patch_sums_avx2_fma(const cv::Mat& smoothed, const Patch& patch, const Warp& warp);
PatchSums shifted_sums_avx2_fma(const cv::Mat& smoothed,
                               const Patch& patch,
                               const Eigen::Vector2d& center);

}  // namespace gpo
