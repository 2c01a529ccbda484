// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

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

/// By its place among (fx, fy, cx, cy, coefficients).
double& parameter(Camera& camera, std::size_t k) {
  double* const pinhole[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy};
  return k < 4 ? *pinhole[k] : camera.coefficients[k - 4];
}

}  // namespace

bool is_focal_length(double focal_px) { return focal_px > 0 && focal_px <= 1e6; }

bool are_coefficients(const std::vector<double>& coefficients) {
  return std::ranges::all_of(coefficients,
                             [](double k) { return std::abs(k) <= kLargestCoefficient; });
}

bool has_near_principal_point(const Camera& camera) {
  if (camera.width == 0 || camera.height == 0) return true;
  return camera.cx > -camera.width && camera.cx < 2 * camera.width && camera.cy > -camera.height &&
         camera.cy < 2 * camera.height;
}

void check_camera(const Camera& camera) {
  const auto positive = [](double focal) { return std::isfinite(focal) && focal > 0; };
  if (!positive(camera.fx) || !positive(camera.fy) || !std::isfinite(camera.cx + camera.cy)) {
    throw InputError(
        fmt::format("camera: fx {}, fy {}, cx {}, cy {}, expected focal lengths above 0",
                    camera.fx,
                    camera.fy,
                    camera.cx,
                    camera.cy));
  }
}

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

Eigen::Matrix2Xd undistortion_sigmas_px(const Camera& camera, const Vector2d& undistorted_px) {
  constexpr double kStep = 1e-5;  // normalized; and of a standard deviation
  const Vector2d x = from_pixel(camera, undistorted_px);
  const auto raw = [](const Camera& by, const Vector2d& at) {
    return to_pixel(by, distort_normalized(lens_of(by), at));
  };
  // The picture's point stays: 0 = d raw / d parameter + (d raw / d x) dx.
  Eigen::Matrix2d slope;
  for (int k = 0; k < 2; ++k) {
    const Vector2d step = kStep * Vector2d::Unit(k);
    slope.col(k) = (raw(camera, x + step) - raw(camera, x - step)) / (2 * kStep);
  }
  const Eigen::Matrix2d inverse = slope.inverse();
  Eigen::Matrix2Xd moves(2, camera.sigmas.size());
  Camera other = camera;
  for (std::size_t k = 0; k < camera.sigmas.size(); ++k) {
    const double value = parameter(other, k);
    const double step = kStep * camera.sigmas[k];
    parameter(other, k) = value + step;
    const Vector2d more = raw(other, x);
    parameter(other, k) = value - step;
    const Vector2d dx = -(inverse * (more - raw(other, x))) / (2 * kStep);
    parameter(other, k) = value;
    moves.col(static_cast<Eigen::Index>(k)) = dx.cwiseProduct(Vector2d(camera.fx, camera.fy));
  }
  return moves;
}

}  // namespace gpo
