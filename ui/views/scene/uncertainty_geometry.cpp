// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/uncertainty_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kSides = 48;  // of a closed line

/// Semi-axes of x' C^-1 x = chi_square as columns, the longest last.
Matrix3d semi_axes(const Matrix3d& covariance, double chi_square) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
  const Vector3d lengths = (chi_square * eigen.eigenvalues().cwiseMax(0)).cwiseSqrt();
  return eigen.eigenvectors() * lengths.asDiagonal();
}

/// The ellipse of two semi-axes, about zero.
std::vector<Vector3d> ellipse(const Vector3d& a, const Vector3d& b) {
  std::vector<Vector3d> line;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSides;
    line.emplace_back(std::cos(angle) * a + std::sin(angle) * b);
  }
  return line;
}

}  // namespace

EllipsoidLines confidence_ellipsoid(const Vector3d& center,
                                    const Matrix3d& covariance,
                                    double enlarged) {
  const Matrix3d axes = enlarged * semi_axes(covariance, kChiSquare3);
  EllipsoidLines lines;
  for (int k = 0; k < 3; ++k) {
    lines[k] = ellipse(axes.col(k), axes.col((k + 1) % 3));
    for (Vector3d& point : lines[k]) point += center;
  }
  return lines;
}

NormalArrow normal_arrow(const Inspection& inspection, const PlaneGrid& grid) {
  Vector3d cameras = Vector3d::Zero();
  for (const Pose& pose : inspection.initialization->cameras) cameras += pose.p_wc;
  cameras /= std::max<double>(1, static_cast<double>(inspection.initialization->cameras.size()));
  const auto [i0, j0] = grid.low;
  const auto [i1, j1] = grid.high;
  const double i = (i0 + i1) / 2.0, j = (j0 + j1) / 2.0;
  const std::array<Vector3d, 4> edges = {
      grid.at(i0, j), grid.at(i1, j), grid.at(i, j0), grid.at(i, j1)};
  const double length = 0.4 * grid.cell * std::min(i1 - i0, j1 - j0);
  NormalArrow arrow;
  arrow.base = *std::ranges::max_element(
      edges, {}, [&](const Vector3d& edge) { return (edge - cameras).norm(); });
  arrow.tip = arrow.base + length * grid.normal;
  const Vector3d back = arrow.tip - 0.14 * length * grid.normal;
  const Vector3d x = 0.05 * length * grid.x, y = 0.05 * length * grid.y;
  arrow.head = {back + x, back - x, back + y, back - y};
  return arrow;
}

std::vector<Vector3d> confidence_rim(const NormalArrow& arrow,
                                     const Matrix3d& normal_covariance,
                                     double enlarged) {
  const Vector3d along = arrow.tip - arrow.base;
  const Matrix3d axes = enlarged * semi_axes(normal_covariance, kChiSquare2);
  std::vector<Vector3d> rim = ellipse(axes.col(1), axes.col(2));
  for (Vector3d& turn : rim) {
    const double angle = std::min(turn.norm(), std::numbers::pi / 2);
    const Vector3d aside = angle > 0 ? Vector3d(turn.normalized()) : Vector3d::Zero().eval();
    turn = arrow.base + std::cos(angle) * along + std::sin(angle) * along.norm() * aside;
  }
  return rim;
}

}  // namespace gpo
