// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A camera that moves while its rows are read. The time stamp is that of the middle row.
struct RollingCamera {
  const Camera& camera;
  double row_delay_s = 0;  ///< from one row to the next; 0: all rows at once
  RowMotion motion = {};
};

/// Returns the motion in another unit of length: `factor` of them are one of the given unit.
RowMotion scaled(RowMotion motion, double factor);

/// Returns the pose, in the camera's axes at the time stamp, from which the row of a pixel was
/// read. Rows beyond the image are read with its first or last one.
Pose pose_at_row(const RollingCamera& camera, const Eigen::Vector2d& raw_px);

/// Projects a point, given in the camera's axes at the time stamp, to the pixel whose row is read
/// when the point is there [raw px]. NaN as for `project(Camera, ...)`.
Eigen::Vector2d project(const RollingCamera& camera, const Eigen::Vector3d& point_c);

/// Returns the point of a plane that a pixel shows, in the world; nullopt if its ray misses the
/// plane. `pose`: at the time stamp.
std::optional<Eigen::Vector3d> intersect(const Plane& plane_w,
                                         const Pose& pose,
                                         const RollingCamera& camera,
                                         const Eigen::Vector2d& raw_px);

/// Returns the pixels [raw px] at which the points of a plane that pixels show would have been seen
/// at the time stamp. Pixels whose rays miss the plane stay.
std::vector<Eigen::Vector2d> at_time_stamp(std::vector<Eigen::Vector2d> raw_px,
                                           const Plane& plane_w,
                                           const Pose& pose,
                                           const RollingCamera& camera);

}  // namespace gpo
