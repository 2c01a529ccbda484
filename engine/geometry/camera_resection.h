// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <optional>

#include <Eigen/Core>

namespace gpo {

/// A camera's pose from points that it sees, and how well it sees them.
struct Resection {
  Pose pose;
  double median_px;  ///< median reprojection error [px]
};

/// Gauss-Newton on the reprojection error of those points that are within three robust standard
/// deviations (of the median error), chosen anew in each step. Both with n columns; `pixels` are
/// undistorted. Nothing where fewer than 4 points are in front of the camera.
std::optional<Resection> refine_pose(const Pose& start,
                                     const Eigen::Matrix3Xd& points_w,
                                     const Eigen::Matrix2Xd& pixels,
                                     const Eigen::Matrix3d& K);

/// Perspective-n-point without a start: SQPnP, which unlike EPnP also suits points near a plane,
/// and `refine_pose` from it. n >= 4.
std::optional<Resection> resect_camera(const Eigen::Matrix3Xd& points_w,
                                       const Eigen::Matrix2Xd& pixels,
                                       const Eigen::Matrix3d& K);

}  // namespace gpo
