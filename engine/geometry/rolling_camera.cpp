// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/rolling_camera.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {

RowMotion scaled(RowMotion motion, double factor) {
  motion.translation_s *= factor;
  motion.translation_s2 *= factor;
  return motion;
}

Pose pose_at_row(const RollingCamera& camera, const Eigen::Vector2d& raw_px) {
  const double half = 0.5 * readout_lines(camera.camera);
  const double row = std::clamp(row_from_middle(camera.camera, raw_px), -half, half);
  const double t = row * camera.row_delay_s;
  const RowMotion& motion = camera.motion;
  return {so3_exp(t * motion.rotation_rad_s + 0.5 * t * t * motion.rotation_rad_s2),
          t * motion.translation_s + 0.5 * t * t * motion.translation_s2};
}

Eigen::Vector2d project(const RollingCamera& camera, const Eigen::Vector3d& point_c) {
  constexpr int kRounds = 3;  // the row depends on the pose, and vice versa
  Eigen::Vector2d raw_px = project(camera.camera, point_c);
  if (camera.row_delay_s == 0) return raw_px;
  for (int round = 0; round < kRounds && raw_px.allFinite(); ++round)
    raw_px = project(camera.camera, to_camera(pose_at_row(camera, raw_px), point_c));
  return raw_px;
}

std::optional<Eigen::Vector3d> intersect(const Plane& plane_w,
                                         const Pose& pose,
                                         const RollingCamera& camera,
                                         const Eigen::Vector2d& raw_px) {
  const Eigen::Vector3d ray =
      intrinsic_matrix(camera.camera).inverse() * undistort(camera.camera, raw_px).homogeneous();
  return intersect(plane_w, pose * pose_at_row(camera, raw_px), ray);
}

std::vector<Eigen::Vector2d> at_time_stamp(std::vector<Eigen::Vector2d> raw_px,
                                           const Plane& plane_w,
                                           const Pose& pose,
                                           const RollingCamera& camera) {
  if (camera.row_delay_s == 0) return raw_px;
  for (Eigen::Vector2d& px : raw_px)
    if (const auto point = intersect(plane_w, pose, camera, px))
      px = project(camera.camera, to_camera(pose, *point));
  return raw_px;
}

}  // namespace gpo
