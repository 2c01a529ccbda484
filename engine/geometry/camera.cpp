// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

double coefficient(const Camera& camera, std::size_t i) {
  return i < camera.coefficients.size() ? camera.coefficients[i] : 0.0;
}

Vector2d to_pixel(const Camera& camera, const Vector2d& x) {
  return {camera.fx * x.x() + camera.cx, camera.fy * x.y() + camera.cy};
}

Vector2d from_pixel(const Camera& camera, const Vector2d& px) {
  return {(px.x() - camera.cx) / camera.fx, (px.y() - camera.cy) / camera.fy};
}

/// Brown's model with OpenCV's order of coefficients: k1 k2 p1 p2 k3 k4 k5 k6.
Vector2d distort_radial_tangential(const Camera& c, const Vector2d& x) {
  const double r2 = x.squaredNorm();
  const double radial =
      (1 + r2 * (coefficient(c, 0) + r2 * (coefficient(c, 1) + r2 * coefficient(c, 4)))) /
      (1 + r2 * (coefficient(c, 5) + r2 * (coefficient(c, 6) + r2 * coefficient(c, 7))));
  const double p1 = coefficient(c, 2);
  const double p2 = coefficient(c, 3);
  const double xy = x.x() * x.y();
  return radial * x + Vector2d(2 * p1 * xy + p2 * (r2 + 2 * x.x() * x.x()),
                               p1 * (r2 + 2 * x.y() * x.y()) + 2 * p2 * xy);
}

/// Kannala-Brandt: the angle from the optical axis that the picture shows, for the true one.
double distorted_angle(const Camera& c, double theta) {
  const double t2 = theta * theta;
  return theta *
         (1 + t2 * (coefficient(c, 0) +
                    t2 * (coefficient(c, 1) + t2 * (coefficient(c, 2) + t2 * coefficient(c, 3)))));
}

Vector2d distort_normalized(const Camera& camera, const Vector2d& x) {
  switch (camera.distortion) {
    case Distortion::radial_tangential:
      return distort_radial_tangential(camera, x);
    case Distortion::equidistant: {
      const double r = x.norm();
      return r < 1e-12 ? x : Vector2d(x * (distorted_angle(camera, std::atan(r)) / r));
    }
    case Distortion::none:
      break;
  }
  return x;
}

const Vector2d kNowhere = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
constexpr int kNewtonSteps = 30;
constexpr double kDifference = 1e-6;  // of the central differences, in normalized coordinates

Vector2d invert_radial_tangential(const Camera& camera,
                                  const Vector2d& distorted,
                                  double tolerance) {
  Vector2d x = distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector2d error = distort_radial_tangential(camera, x) - distorted;
    if (error.norm() < tolerance) return x;
    Matrix2d J;
    for (int k = 0; k < 2; ++k) {
      const Vector2d h = kDifference * Vector2d::Unit(k);
      J.col(k) =
          (distort_radial_tangential(camera, x + h) - distort_radial_tangential(camera, x - h)) /
          (2 * kDifference);
    }
    // Beyond the fold of the polynomial the model maps two directions to one pixel.
    if (!(J.determinant() > 0)) return kNowhere;
    x -= J.inverse() * error;
  }
  return kNowhere;
}

Vector2d invert_equidistant(const Camera& camera, const Vector2d& distorted, double tolerance) {
  const double r_distorted = distorted.norm();
  if (r_distorted < 1e-12) return distorted;
  double theta = r_distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double error = distorted_angle(camera, theta) - r_distorted;
    if (std::abs(error) < tolerance) {
      const bool in_front = theta < std::numbers::pi / 2;
      return in_front ? Vector2d(distorted * (std::tan(theta) / r_distorted)) : kNowhere;
    }
    const double slope = (distorted_angle(camera, theta + kDifference) -
                          distorted_angle(camera, theta - kDifference)) /
                         (2 * kDifference);
    if (!(slope > 0)) return kNowhere;
    theta -= error / slope;
  }
  return kNowhere;
}

}  // namespace

Eigen::Matrix3d intrinsic_matrix(const Camera& camera) {
  Eigen::Matrix3d K;
  K << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return K;
}

Vector2d project_undistorted(const Camera& camera, const Eigen::Vector3d& point_c) {
  return to_pixel(camera, point_c.hnormalized());
}

Vector2d project(const Camera& camera, const Eigen::Vector3d& point_c) {
  return to_pixel(camera, distort_normalized(camera, point_c.hnormalized()));
}

Vector2d distort(const Camera& camera, const Vector2d& undistorted_px) {
  return to_pixel(camera, distort_normalized(camera, from_pixel(camera, undistorted_px)));
}

Vector2d undistort(const Camera& camera, const Vector2d& raw_px) {
  const double tolerance = 1e-10 / std::max(camera.fx, camera.fy);
  const Vector2d distorted = from_pixel(camera, raw_px);
  switch (camera.distortion) {
    case Distortion::radial_tangential:
      return to_pixel(camera, invert_radial_tangential(camera, distorted, tolerance));
    case Distortion::equidistant:
      return to_pixel(camera, invert_equidistant(camera, distorted, tolerance));
    case Distortion::none:
      break;
  }
  return raw_px;
}

}  // namespace gpo
