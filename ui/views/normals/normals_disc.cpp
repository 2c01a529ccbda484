// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/normals/normals_disc.h"

#include "engine/geometry/pose.h"
#include "engine/methods/plane/normal_landscape.h"
#include "ui/views/scene/uncertainty_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCorners = 72;

/// Normals that are turned by `a cos + b sin` [rad], a and b perpendicular to the normal.
std::vector<Vector2d> closed_line(const Vector3d& normal, const Vector3d& a, const Vector3d& b) {
  std::vector<Vector2d> line;
  for (int k = 0; k < kCorners; ++k) {
    const double phase = 2 * std::numbers::pi * k / kCorners;
    const Vector3d turn = std::cos(phase) * a + std::sin(phase) * b;
    const double angle = std::min(turn.norm(), std::numbers::pi / 2);
    const Vector3d turned =
        angle < 1e-12 ? normal : std::cos(angle) * normal + std::sin(angle) * turn.normalized();
    line.push_back(disc_from_normal(turned));
  }
  return line;
}

}  // namespace

std::vector<Vector2d> circle_on_disc(const Vector3d& normal, double radius_deg) {
  const Vector3d a = normal.unitOrthogonal();
  return closed_line(normal, radians(radius_deg) * a, radians(radius_deg) * normal.cross(a));
}

std::vector<Vector2d> confidence_on_disc(const Vector3d& normal, const Matrix3d& covariance) {
  // Of the three axes the first is the normal itself, of variance zero.
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(covariance);
  const auto axis = [&](int k) -> Vector3d {
    return std::sqrt(kChiSquare2 * std::max(0.0, axes.eigenvalues()[k])) *
           axes.eigenvectors().col(k);
  };
  return closed_line(normal, axis(1), axis(2));
}

}  // namespace gpo
