// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector2d;

Vector2d to_pixel(const Camera& camera, const Vector2d& x) {
  return {camera.fx * x.x() + camera.cx, camera.fy * x.y() + camera.cy};
}

Lens lens_of(const Camera& camera) { return {camera.distortion, camera.coefficients}; }

Vector2d from_pixel(const Camera& camera, const Vector2d& px) {
  return {(px.x() - camera.cx) / camera.fx, (px.y() - camera.cy) / camera.fy};
}

}  // namespace

Eigen::Matrix3d intrinsic_matrix(const Camera& camera) {
  Eigen::Matrix3d K;
  K << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return K;
}

Vector2d project(const Camera& camera, const Eigen::Vector3d& point_c) {
  return to_pixel(camera, distort_normalized(lens_of(camera), point_c.hnormalized()));
}

Vector2d distort(const Camera& camera, const Vector2d& undistorted_px) {
  return to_pixel(camera, distort_normalized(lens_of(camera), from_pixel(camera, undistorted_px)));
}

Vector2d undistort(const Camera& camera, const Vector2d& raw_px) {
  if (camera.distortion == Distortion::none) return raw_px;
  const double tolerance = 1e-10 / std::max(camera.fx, camera.fy);
  return to_pixel(camera,
                  undistort_normalized(lens_of(camera), from_pixel(camera, raw_px), tolerance));
}

}  // namespace gpo
