// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <cstdint>
#include <optional>

namespace gpo {

/// The plane normal . P + distance = 0 with |normal| = 1. By convention distance > 0: the normal
/// points to the side of the origin.
struct Plane {
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  double distance = 1;  ///< from the origin [unit of the frame]
};

/// Returns the same plane with its normal towards the origin.
Plane facing_origin(const Plane& plane);

/// Returns the plane in the camera frame (not flipped).
Plane plane_in_camera(const Plane& plane_w, const Pose& pose);

/// Returns an orthonormal basis of the tangent space of the unit sphere at `normal`.
Eigen::Matrix<double, 3, 2> normal_tangents(const Eigen::Vector3d& normal);

/// Returns the intersection of the plane and the ray from the camera center along `ray_c` (camera
/// frame), in the world; nullopt if they do not meet in front of the camera.
std::optional<Eigen::Vector3d> intersect(const Plane& plane_w,
                                         const Pose& pose,
                                         const Eigen::Vector3d& ray_c);

/// Fits a plane to points (3 x n) by 3-point RANSAC and total least squares over the inliers, which
/// are within 2 % of the median distance of the points; the normal points towards the origin.
/// nullopt for fewer than 3 points or if all are on a line.
std::optional<Plane> fit_plane(const Eigen::Matrix3Xd& points, std::uint64_t seed = 1);

}  // namespace gpo
