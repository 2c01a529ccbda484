// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <Eigen/Core>

namespace gpo {

/// Linearization point of a frame's transfer errors.
struct FrameState {
  Eigen::Matrix3d R_cw = Eigen::Matrix3d::Identity();
  Eigen::Vector3d tau_c = Eigen::Vector3d::Zero();  ///< R_cw tau, in the frame's camera axes [d]
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  Eigen::Matrix<double, 3, 2> tangents = {};  ///< orthonormal basis of the normal's tangent space
  double fx = 1, fy = 1;                      ///< [px]
};

/// Transfer of a point of the plane to a frame (engine/method.md, eq. 3; R_wc1 = I), with its
/// derivatives:  y = R_cw (I - tau n^T) x_1,  p = pi(K y).  The residual of GPO is `pixel - p_i`.
struct Transfer {
  Eigen::Vector3d ray_1;            ///< x_1 = K^-1 p_1
  Eigen::Vector3d tau_c;            ///< R_cw tau
  double height = 0;                ///< n . x_1
  Eigen::Vector3d y;                ///< in the frame's camera axes
  Eigen::Vector2d pixel;            ///< undistorted, relative to the principal point [px]
  Eigen::Matrix<double, 2, 3> d_y;  ///< dp/dy [px]

  bool in_front() const { return y.z() > 0; }
  /// dp/dn [px].
  Eigen::Matrix<double, 2, 3> d_normal() const { return -(d_y * tau_c) * ray_1.transpose(); }
  /// dp/dphi of R_wc exp(phi) [px/rad].
  Eigen::Matrix<double, 2, 3> d_rotation() const { return d_y * skew(y); }
  /// dp/dt of tau + R_wc t [px].
  Eigen::Matrix<double, 2, 3> d_translation() const { return -height * d_y; }
  /// dp/dp_1, the slope of the homography.
  Eigen::Matrix2d d_reference(const FrameState& state) const {
    const Eigen::Matrix<double, 3, 2> A =
        state.R_cw.leftCols<2>() - tau_c * state.normal.head<2>().transpose();
    return d_y * (A * Eigen::Vector2d(1 / state.fx, 1 / state.fy).asDiagonal());
  }
  /// dp/d(u, phi, t), u over the normal's tangents.
  Eigen::Matrix<double, 2, 8> jacobian(const Eigen::Matrix<double, 3, 2>& tangents) const {
    Eigen::Matrix<double, 2, 8> J;
    J << d_normal() * tangents, d_rotation(), d_translation();
    return J;
  }
};

/// Returns the transfer of the point along `ray_1`. `frame_normals` does the same for all
/// observations of a frame at once.
inline Transfer transfer_on_plane(const FrameState& state, const Eigen::Vector3d& ray_1) {
  Transfer transfer;
  transfer.ray_1 = ray_1;
  transfer.tau_c = state.tau_c;
  transfer.height = state.normal.dot(ray_1);
  transfer.y = state.R_cw * ray_1 - state.tau_c * transfer.height;
  const Eigen::Vector2d focal(state.fx, state.fy);
  const Eigen::Vector2d over_depth = focal / transfer.y.z();
  transfer.pixel = over_depth.cwiseProduct(transfer.y.head<2>());
  transfer.d_y.leftCols<2>() = over_depth.asDiagonal();
  transfer.d_y.col(2) = -transfer.pixel / transfer.y.z();
  return transfer;
}

}  // namespace gpo
