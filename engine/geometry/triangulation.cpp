// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/triangulation.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The point of least summed squared distance from the rays; nothing where they are parallel.
std::optional<Vector3d> nearest_to_rays(std::span<const Pose> cameras,
                                        const Eigen::Matrix3Xd& rays) {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Vector3d ray_w = (cameras[i].R_wc * rays.col(static_cast<int>(i))).normalized();
    const Matrix3d across = Matrix3d::Identity() - ray_w * ray_w.transpose();
    A += across;
    b += across * cameras[i].p_wc;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(A);
  if (!(eigen.eigenvalues()(0) > 1e-10 * eigen.eigenvalues()(2))) return std::nullopt;
  return A.ldlt().solve(b);
}

}  // namespace

std::optional<Vector3d> triangulate(std::span<const Pose> cameras, const Eigen::Matrix3Xd& rays) {
  auto point = nearest_to_rays(cameras, rays);
  for (int step = 0; point && step < 5; ++step) {
    Matrix3d JtJ = Matrix3d::Zero();
    Vector3d Jtr = Vector3d::Zero();
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const Vector3d y = to_camera(cameras[i], *point);
      if (!(y.z() > 0)) return std::nullopt;
      Eigen::Matrix<double, 2, 3> d_y;  // of x = pi(y)
      d_y << 1, 0, -y.x() / y.z(), 0, 1, -y.y() / y.z();
      const Eigen::Matrix<double, 2, 3> J = d_y * cameras[i].R_wc.transpose() / y.z();
      JtJ += J.transpose() * J;
      Jtr += J.transpose() * (y.hnormalized() - rays.col(static_cast<int>(i)).head<2>());
    }
    const Vector3d delta = JtJ.ldlt().solve(-Jtr);
    if (!delta.allFinite()) return std::nullopt;
    *point += delta;
    if (delta.norm() < 1e-12 * point->norm()) break;
  }
  const auto in_front = [&](const Pose& camera) { return to_camera(camera, *point).z() > 0; };
  return point && std::ranges::all_of(cameras, in_front) ? point : std::nullopt;
}

double parallax_deg(std::span<const Pose> cameras, const Vector3d& point_w) {
  double largest = 0;
  for (const Pose& camera : cameras.subspan(1)) {
    const double angle = angle_deg(point_w - cameras.front().p_wc, point_w - camera.p_wc);
    largest = std::max(largest, angle);
  }
  return largest;
}

}  // namespace gpo
