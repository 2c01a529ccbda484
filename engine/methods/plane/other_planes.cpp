// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/other_planes.h"

#include "engine/methods/plane/plane_observations.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kRounds = 3;
/// Smallest to largest eigenvalue of the normal matrix, below which the cameras' motion does not
/// tell a plane.
constexpr double kLeastCondition = 1e-9;

/// Normal equations over m, of the errors weighted to pixels by the depths that `m` gives.
struct LinearSystem {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  int in_front = 0;
  int behind = 0;
};

LinearSystem system_at(const Window& window,
                       const PlaneMotion& motion,
                       int plane,
                       const Vector3d& m) {
  const Matrix3d K_inverse = window.K.inverse();
  LinearSystem system;
  for (int i = 1; i < window.frame_count(); ++i) {
    const Matrix3d R_cw = motion.R_wc[i].transpose();
    const Vector3d tau_c = R_cw * motion.tau[i];
    for (const int j : window.planes[plane].tracks) {
      if (!window.planes[plane].inlier[i][j]) continue;
      const Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
      const Vector3d seen = K_inverse * window.points_px[i].col(j).homogeneous();
      const Vector3d turned = R_cw * ray_1;
      const double depth = (turned - tau_c * m.dot(ray_1)).z();
      (depth > 0 && m.dot(ray_1) <= 0 ? system.in_front : system.behind) += 1;
      const double weight = 1 / std::max(depth * depth, 1e-6);
      // The two rows of [x_i]x that do not involve the third one: error in the picture times depth.
      for (int row = 0; row < 2; ++row) {
        const double slope = tau_c(row) - seen(row) * tau_c.z();
        const double right = turned(row) - seen(row) * turned.z();
        system.A += weight * slope * slope * ray_1 * ray_1.transpose();
        system.b += weight * slope * right * ray_1;
      }
    }
  }
  return system;
}

std::optional<Vector3d> plane_from_cameras(const Window& window,
                                           const PlaneMotion& motion,
                                           int plane) {
  Vector3d m = Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    const LinearSystem system = system_at(window, motion, plane, m);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(system.A);
    if (!(eigen.eigenvalues()(0) > kLeastCondition * eigen.eigenvalues()(2))) return std::nullopt;
    m = eigen.eigenvectors() *
        (eigen.eigenvectors().transpose() * system.b).cwiseQuotient(eigen.eigenvalues());
    if (!m.allFinite()) return std::nullopt;
  }
  const LinearSystem last = system_at(window, motion, plane, m);
  return last.behind * 10 > last.in_front ? std::nullopt : std::optional(m);
}

}  // namespace

std::vector<OtherPlane> other_planes(const Window& window, const PlaneMotion& motion) {
  std::vector<OtherPlane> planes;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k) {
    if (k == window.leader || static_cast<int>(planes.size()) == kMostOtherPlanes) continue;
    if (const auto m = plane_from_cameras(window, motion, k)) planes.push_back({k, *m});
  }
  return planes;
}

std::vector<int> numbers_of(const std::vector<OtherPlane>& planes) {
  std::vector<int> numbers(planes.size());
  std::ranges::transform(planes, numbers.begin(), &OtherPlane::number);
  return numbers;
}

}  // namespace gpo
