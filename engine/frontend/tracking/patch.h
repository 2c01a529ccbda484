// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// How many of a look's pixels are added up at a time.
constexpr int kPatchKernelWidth = 8;

/// The whole pixels around a place in a soft picture (smoothed_image.h), padded to a multiple of the
/// kernel's width. What is padding, or outside of the picture, is zero in all but the offsets.
struct Patch {
  std::vector<float> dx;          ///< from its middle [px]
  std::vector<float> dy;          ///< [px]
  std::vector<float> slope_x;     ///< [brightness / px]
  std::vector<float> slope_y;     ///< [brightness / px]
  std::vector<float> brightness;  ///< without its mean
  std::vector<float> one;         ///< 1 in the picture
  int half = 0;                   ///< the farthest dx and dy [px]
};

/// The pixels from `-half` to `half` around a pixel.
Patch make_patch(const cv::Mat& smoothed, const cv::Point& middle, int half);

/// Sums of the products of a look's columns, which are: slopes along x and y; slope along x times
/// dx, dy; slope along y times dx, dy; brightness; 1.
using PatchNormalMatrix = Eigen::Matrix<double, 8, 8>;
PatchNormalMatrix patch_normal_matrix(const Patch& patch);

/// Where a look's pixels are in a picture: those at d from its middle are at
/// center + linear d + quadratic (d_x^2, d_x d_y, d_y^2).
struct Warp {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [px]
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 2, 3> quadratic = Eigen::Matrix<double, 2, 3>::Zero();  ///< [1 / px]

  Eigen::Vector2d operator()(const Eigen::Vector2d& d) const {
    return center + linear * d +
           quadratic * Eigen::Vector3d(d.x() * d.x(), d.x() * d.y(), d.y() * d.y());
  }
};

/// The farthest along x and y that any of a look's pixels can be from the warp's center [px].
Eigen::Vector2d reach_px(const Patch& patch, const Warp& warp);

/// Whether a picture holds all pixels of a look where a warp puts them.
bool is_inside(const cv::Size& image, const Patch& patch, const Warp& warp);

/// The look with only those of its pixels that a picture holds where a warp puts them; the others
/// are zero, offsets and all. The warp's center is to be inside.
Patch inside_part(const cv::Size& image, const Patch& patch, const Warp& warp);

}  // namespace gpo
