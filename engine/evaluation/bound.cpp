// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/evaluation/bound.h"

#include "engine/geometry/decompositions.h"
#include "engine/initializers/plane/plane_motion.h"
#include "engine/initializers/residuals/transfer.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {

std::optional<double> normal_bound_deg(const Window& window,
                                       const Plane& plane,
                                       std::span<const Pose> cameras,
                                       double sigma_px) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  const Eigen::Vector3d& n = plane.normal;
  const Eigen::Matrix<double, 3, 2> N = normal_tangents(n);
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (int i = 1; i < window.frame_count(); ++i) {
    Eigen::Matrix2d nn = Eigen::Matrix2d::Zero();
    Eigen::Matrix<double, 2, 3> nt = Eigen::Matrix<double, 2, 3>::Zero();
    Eigen::Matrix3d tt = Eigen::Matrix3d::Zero();
    for (int j = 0; j < window.track_count(); ++j) {
      if (!window.inlier[i][j]) continue;
      const Eigen::Vector3d ray = K_inverse * window.points_px[0].col(j).homogeneous();
      const Transfer transfer =
          transfer_on_plane(window.K, cameras[i].R_wc, ray, n, -cameras[i].p_wc / plane.distance);
      const Eigen::Matrix2d J_n = transfer.d_normal * N;
      nn += J_n.transpose() * J_n;
      nt += J_n.transpose() * transfer.d_tau;
      tt += transfer.d_tau.transpose() * transfer.d_tau;
    }
    information += nn - nt * solve_symmetric(tt, nt.transpose());  // Schur complement over tau_i
  }
  const Eigen::Matrix2d covariance = sigma_px * sigma_px * information.inverse();
  const double bound_deg = degrees(std::sqrt(covariance.trace()));
  return std::isfinite(bound_deg) ? std::optional(bound_deg) : std::nullopt;
}

}  // namespace gpo
