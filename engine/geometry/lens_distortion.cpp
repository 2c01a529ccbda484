// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/lens_distortion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kNewtonSteps = 30;
constexpr int kSamples = 64;          // of the way from the axis, to find a fold
constexpr double kDifference = 1e-6;  // of the central differences, in normalized coordinates
const Vector2d kNowhere(kNaN, kNaN);

double coefficient(const Lens& lens, std::size_t i) {
  return i < lens.coefficients.size() ? lens.coefficients[i] : 0.0;
}

/// A tilted sensor behind the lens, tau_x and tau_y [rad], as OpenCV's CALIB_TILTED_MODEL.
Vector2d tilted(double tau_x, double tau_y, const Vector2d& x) {
  Eigen::Matrix3d R_x;
  Eigen::Matrix3d R_y;
  R_x << 1, 0, 0, 0, std::cos(tau_x), std::sin(tau_x), 0, -std::sin(tau_x), std::cos(tau_x);
  R_y << std::cos(tau_y), 0, -std::sin(tau_y), 0, 1, 0, std::sin(tau_y), 0, std::cos(tau_y);
  const Eigen::Matrix3d R = R_y * R_x;
  Eigen::Matrix3d onto_sensor;
  onto_sensor << R(2, 2), 0, -R(0, 2), 0, R(2, 2), -R(1, 2), 0, 0, 1;
  return (onto_sensor * R * x.homogeneous()).hnormalized();
}

/// Brown's model with OpenCV's order of coefficients:
/// k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y.
Vector2d radial_tangential(const Lens& c, const Vector2d& x) {
  const double r2 = x.squaredNorm();
  const double radial =
      (1 + r2 * (coefficient(c, 0) + r2 * (coefficient(c, 1) + r2 * coefficient(c, 4)))) /
      (1 + r2 * (coefficient(c, 5) + r2 * (coefficient(c, 6) + r2 * coefficient(c, 7))));
  const double p1 = coefficient(c, 2);
  const double p2 = coefficient(c, 3);
  const double xy = x.x() * x.y();
  Vector2d distorted = radial * x + Vector2d(2 * p1 * xy + p2 * (r2 + 2 * x.x() * x.x()),
                                             p1 * (r2 + 2 * x.y() * x.y()) + 2 * p2 * xy);
  if (c.coefficients.size() <= 8) return distorted;
  distorted += r2 * Vector2d(coefficient(c, 8) + r2 * coefficient(c, 9),
                             coefficient(c, 10) + r2 * coefficient(c, 11));
  if (c.coefficients.size() <= 12) return distorted;
  return tilted(coefficient(c, 12), coefficient(c, 13), distorted);
}

/// Whether the radial part r N(r^2) / D(r^2) of Brown's model rises at s = r^2, and has no pole.
bool rises(const Lens& c, double s) {
  const double k1 = coefficient(c, 0), k2 = coefficient(c, 1), k3 = coefficient(c, 4);
  const double k4 = coefficient(c, 5), k5 = coefficient(c, 6), k6 = coefficient(c, 7);
  const double N = 1 + s * (k1 + s * (k2 + s * k3));
  const double D = 1 + s * (k4 + s * (k5 + s * k6));
  const double dN = k1 + s * (2 * k2 + s * 3 * k3);
  const double dD = k4 + s * (2 * k5 + s * 3 * k6);
  return D > 0 && (N + 2 * s * dN) * D - 2 * s * N * dD > 0;
}

/// Surely without a fold up to r^2 = s: the negative terms together do not reach the leading 1.
bool plainly_rises(const Lens& c, double s) {
  if (c.coefficients.size() > 5) return false;
  const auto falling = [](double k) { return std::max(0.0, -k); };
  return s * (3 * falling(coefficient(c, 0)) +
              s * (5 * falling(coefficient(c, 1)) + s * 7 * falling(coefficient(c, 4)))) <
         1;
}

bool within_valid_radius(const Lens& lens, const Vector2d& ideal) {
  const double s = ideal.squaredNorm();
  if (!std::isfinite(s)) return false;
  if (plainly_rises(lens, s)) return true;
  for (int i = 1; i <= kSamples; ++i) {
    const double part = static_cast<double>(i) / kSamples;
    if (!rises(lens, s * part * part)) return false;
  }
  return true;
}

/// Kannala-Brandt: the angle from the optical axis that the picture shows, for the true one.
double distorted_angle(const Lens& c, double theta) {
  const double t2 = theta * theta;
  return theta *
         (1 + t2 * (coefficient(c, 0) +
                    t2 * (coefficient(c, 1) + t2 * (coefficient(c, 2) + t2 * coefficient(c, 3)))));
}

double slope_of_angle(const Lens& c, double theta) {
  const double t2 = theta * theta;
  return 1 + t2 * (3 * coefficient(c, 0) +
                   t2 * (5 * coefficient(c, 1) +
                         t2 * (7 * coefficient(c, 2) + t2 * 9 * coefficient(c, 3))));
}

bool angle_is_valid(const Lens& lens, double theta) {
  for (int i = 1; i <= kSamples; ++i) {
    if (!(slope_of_angle(lens, theta * i / kSamples) > 0)) return false;
  }
  return true;
}

Vector2d equidistant(const Lens& lens, const Vector2d& x) {
  const double r = x.norm();
  if (r < 1e-12) return x;
  const double theta = std::atan(r);
  if (!angle_is_valid(lens, theta)) return kNowhere;
  return x * (distorted_angle(lens, theta) / r);
}

Vector2d invert_radial_tangential(const Lens& lens, const Vector2d& distorted, double tolerance) {
  Vector2d x = distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector2d error = radial_tangential(lens, x) - distorted;
    if (error.norm() < tolerance) return within_valid_radius(lens, x) ? x : kNowhere;
    Matrix2d J;
    for (int k = 0; k < 2; ++k) {
      const Vector2d h = kDifference * Vector2d::Unit(k);
      J.col(k) =
          (radial_tangential(lens, x + h) - radial_tangential(lens, x - h)) / (2 * kDifference);
    }
    if (!(J.determinant() > 0)) return kNowhere;
    x -= J.inverse() * error;
  }
  return kNowhere;
}

Vector2d invert_equidistant(const Lens& lens, const Vector2d& distorted, double tolerance) {
  const double r_distorted = distorted.norm();
  if (r_distorted < 1e-12) return distorted;
  double theta = r_distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double error = distorted_angle(lens, theta) - r_distorted;
    if (std::abs(error) < tolerance) {
      const bool seen = theta < std::numbers::pi / 2 && angle_is_valid(lens, theta);
      return seen ? Vector2d(distorted * (std::tan(theta) / r_distorted)) : kNowhere;
    }
    const double slope = slope_of_angle(lens, theta);
    if (!(slope > 0)) return kNowhere;
    theta -= error / slope;
  }
  return kNowhere;
}

}  // namespace

Vector2d distort_normalized(const Lens& lens, const Vector2d& ideal) {
  switch (lens.distortion) {
    case Distortion::radial_tangential:
      return within_valid_radius(lens, ideal) ? radial_tangential(lens, ideal) : kNowhere;
    case Distortion::equidistant:
      return equidistant(lens, ideal);
    case Distortion::none:
      break;
  }
  return ideal;
}

Vector2d undistort_normalized(const Lens& lens, const Vector2d& distorted, double tolerance) {
  switch (lens.distortion) {
    case Distortion::radial_tangential:
      return invert_radial_tangential(lens, distorted, tolerance);
    case Distortion::equidistant:
      return invert_equidistant(lens, distorted, tolerance);
    case Distortion::none:
      break;
  }
  return distorted;
}

}  // namespace gpo
