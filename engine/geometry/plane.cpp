// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/plane.h"

#include <cmath>

#include <Eigen/Geometry>

namespace gpo {

Plane facing_origin(const Plane& plane) {
  return plane.distance >= 0 ? plane : Plane{-plane.normal, -plane.distance};
}

Plane plane_in_camera(const Plane& plane_w, const Pose& pose) {
  return {pose.R_wc.transpose() * plane_w.normal, plane_w.distance + plane_w.normal.dot(pose.p_wc)};
}

Eigen::Matrix<double, 3, 2> normal_tangents(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  return tangents;
}

std::optional<Eigen::Vector3d> intersect(const Plane& plane_w,
                                         const Pose& pose,
                                         const Eigen::Vector3d& ray_c) {
  // Depth along the ray: m = (-d - n.p_wc) / (n . R_wc x); engine/method.md, eq. 12.
  const Eigen::Vector3d ray_w = pose.R_wc * ray_c;
  const double along = plane_w.normal.dot(ray_w);
  const double depth = (-plane_w.distance - plane_w.normal.dot(pose.p_wc)) / along;
  if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
  return pose.p_wc + depth * ray_w;
}

}  // namespace gpo
