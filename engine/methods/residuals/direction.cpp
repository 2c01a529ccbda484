// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/residuals/direction.h"

#include <cmath>

namespace gpo {
namespace {

/// Columns: the tangent directions N at q.
Eigen::Matrix<double, 3, 2> tangents(const Eigen::Quaterniond& q) {
  return q.toRotationMatrix().leftCols<2>();
}

Eigen::Quaterniond exponential(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  const double s = angle < 1e-9 ? 0.5 : std::sin(angle / 2) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(angle / 2);
  q.vec() = s * rotation_rad;
  return q;
}

}  // namespace

Eigen::Vector3d direction(const Eigen::Quaterniond& q) {
  return {2 * (q.x() * q.z() + q.w() * q.y()),
          2 * (q.y() * q.z() - q.w() * q.x()),
          q.w() * q.w() - q.x() * q.x() - q.y() * q.y() + q.z() * q.z()};
}

Eigen::Matrix<double, 3, 4> direction_jacobian(const Eigen::Quaterniond& q) {
  Eigen::Matrix<double, 3, 4> J;
  J << q.z(), q.w(), q.x(), q.y(), -q.w(), q.z(), q.y(), -q.x(), -q.x(), -q.y(), q.z(), q.w();
  return 2 * J;
}

Eigen::Quaterniond direction_plus(const Eigen::Quaterniond& q, const Eigen::Vector2d& u) {
  return (exponential(tangents(q) * u) * q).normalized();
}

Eigen::Matrix<double, 4, 2> direction_plus_jacobian(const Eigen::Quaterniond& q) {
  const Eigen::Matrix<double, 3, 2> N = tangents(q);
  Eigen::Matrix<double, 4, 2> J;
  for (int k = 0; k < 2; ++k) {
    Eigen::Quaterniond imaginary;
    imaginary.w() = 0;
    imaginary.vec() = N.col(k);
    J.col(k) = 0.5 * (imaginary * q).coeffs();
  }
  return J;
}

Eigen::Vector2d direction_minus(const Eigen::Quaterniond& y, const Eigen::Quaterniond& x) {
  const Eigen::Vector3d from = direction(x);
  const Eigen::Vector3d to = direction(y);
  const Eigen::Vector3d axis = from.cross(to);
  const double sine = axis.norm();
  const double angle = std::atan2(sine, from.dot(to));
  const double scale = sine < 1e-12 ? 1.0 : angle / sine;
  return tangents(x).transpose() * (scale * axis);
}

}  // namespace gpo
