// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/lens_distortion.h"

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A calibrated camera. Axes: x right, y down, z forward. Pixels: the center of the top-left pixel
/// is (0, 0), as in OpenCV. "Raw" pixels are those of the picture, "undistorted" ones those of the
/// ideal pinhole camera with the same intrinsics.
struct Camera {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fx = 0;   ///< [px]
  double fy = 0;   ///< [px]
  double cx = 0;   ///< [px]
  double cy = 0;   ///< [px]
  Distortion distortion = Distortion::none;
  std::vector<double> coefficients = {};  ///< as `Lens` orders them; missing ones are zero
  /// Standard deviations of fx, fy, cx, cy [px], then of each coefficient; empty: nobody says.
  std::vector<double> sigmas = {};

  bool operator==(const Camera&) const = default;
};

// What a camera may have: files, messages and callers that say anything else are broken.

/// Largest of a lens' coefficients, and of their standard deviations [-].
inline constexpr double kLargestCoefficient = 1e6;
/// Whether it is positive and at most 1e6 px.
bool is_focal_length(double focal_px);
bool are_coefficients(const std::vector<double>& coefficients);
/// Whether the principal point is in the picture, or not further away than that is wide and high;
/// true where the picture's size is not known.
bool has_near_principal_point(const Camera& camera);
/// Throws InputError where focal lengths are not positive or anything is no number.
void check_camera(const Camera& camera);

/// K, 3x3, of the undistorted image [px].
Eigen::Matrix3d intrinsic_matrix(const Camera& camera);

/// Raw pixel of a point in the camera frame (z > 0); NaN beyond the lens model's valid radius.
Eigen::Vector2d project(const Camera& camera, const Eigen::Vector3d& point_c);

/// Raw pixel where the undistorted pixel appears in the picture; NaN beyond the valid radius.
Eigen::Vector2d distort(const Camera& camera, const Eigen::Vector2d& undistorted_px);

/// Undistorted pixel of a raw one; the inverse of `distort`, by Newton's method to 1e-10 px. NaN
/// where the model has no inverse within its valid radius (far outside of what was calibrated).
Eigen::Vector2d undistort(const Camera& camera, const Eigen::Vector2d& raw_px);

/// How far the undistorted pixel of a picture's point moves, seen through the same K, for one
/// standard deviation of each parameter of which there is one; 2 x that many, first order.
Eigen::Matrix2Xd undistortion_sigmas_px(const Camera& camera,
                                        const Eigen::Vector2d& undistorted_px);

}  // namespace gpo
