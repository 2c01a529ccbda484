// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/eigen_layout.h"
#include "engine/base/error.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"

#include <vector>

#include <Eigen/Core>

/// Every method on a window that the caller filled (`methods`), and single solvers without a
/// `Window`, on data that the caller trusts: they select no inliers and judge no window
/// (`initialize` does both). Pixels are undistorted. Frame 0 is the reference camera, which is the
/// world of the result; the unit is the plane's distance from it. A failure is a result with a
/// reason; InputError is thrown for lists of different lengths.
namespace gpo {

/// Homographies of one plane between the reference camera and each frame.
struct PlaneHomographies {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< intrinsics of the undistorted image [px]
  std::vector<Eigen::Matrix3d> H_i1;  ///< p_i ~ H_i1 p_1, one per frame; the first one is I
  std::vector<Eigen::Matrix3d> R_wc;  ///< rotations to any fixed world, one per frame
  /// Points of the reference image at which the homographies were fitted, 2 x n, n >= 8 [px]. The
  /// errors are measured at these. Empty: a grid over the image around the principal point.
  Eigen::Matrix2Xd points_px = {};
};

/// Normal and translations in closed form (engine/method.md, eq. 8 and 9).
Initialization closed_form_of_homographies(const PlaneHomographies& homographies);

/// Global plane optimization over points that the homographies transfer (eq. 7), rotations held.
Initialization gpo_of_homographies(const PlaneHomographies& homographies);

/// Points of one plane, seen by several frames.
struct PlaneTracks {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< intrinsics of the undistorted image [px]
  std::vector<Eigen::Matrix2Xd> points_px;          ///< one per frame, 2 x tracks; NaN: not seen
  std::vector<Eigen::Matrix3d> R_wc;                ///< rotations to any fixed world, one per frame
};

/// Plane, cameras and points from tracks. `known` holds the rotations (GPO); `free` also estimates
/// all of them, with the noise of the reference positions, from rotations near the true ones
/// (`gpo_joint`), and returns uncertainties. `bias` is not possible here.
Initialization plane_and_cameras(const PlaneTracks& tracks, RotationModel rotations);

}  // namespace gpo
