// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <optional>

#include <Eigen/Core>

namespace gpo {

/// The plane normal . P + distance = 0 with |normal| = 1. A plane that is seen is kept with
/// distance > 0: the origin is on the side that the normal points to, at that distance from it.
struct Plane {
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  double distance = 1;  ///< [unit of the frame]
};

/// The same plane, its normal pointing to the side of the origin.
Plane facing_origin(const Plane& plane);

/// The plane in the camera's frame (not flipped).
Plane plane_in_camera(const Plane& plane_w, const Pose& pose);

/// Two orthonormal directions in which a normal moves, of unit length.
Eigen::Matrix<double, 3, 2> normal_tangents(const Eigen::Vector3d& normal);

/// Where the ray from the camera center along `ray_c` (camera frame) meets the plane, in the
/// world; nothing where it does not meet it in front of the camera.
std::optional<Eigen::Vector3d> intersect(const Plane& plane_w,
                                         const Pose& pose,
                                         const Eigen::Vector3d& ray_c);

}  // namespace gpo
