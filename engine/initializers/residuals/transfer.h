// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

/// Where a plane point of the reference frame is seen in frame i, and how that changes:
/// y = R_ciw (I - tau n^T) x_1,  p = pi(K y)   (engine/method.md, eq. 3; R_wc1 = I).
struct Transfer {
  Eigen::Vector2d pixel;                   ///< undistorted [px]
  Eigen::Matrix<double, 2, 3> d_normal;    ///< dp/dn [px]
  Eigen::Matrix<double, 2, 3> d_tau;       ///< dp/dtau [px]
  Eigen::Matrix<double, 2, 3> d_rotation;  ///< dp/dphi of R_wci exp(phi) [px/rad]
  bool in_front = false;                   ///< y_z > 0
};

/// `ray_1` is K^-1 p_1. One-sided transfer; the residual of GPO is `pixel - p_i`.
Transfer transfer_on_plane(const Eigen::Matrix3d& K,
                           const Eigen::Matrix3d& R_wci,
                           const Eigen::Vector3d& ray_1,
                           const Eigen::Vector3d& normal,
                           const Eigen::Vector3d& tau);

/// A direction kept as a unit quaternion q, n = q e_z q*, with a two-dimensional tangent: q [+] u =
/// exp(N u) q, where N holds q's images of e_x and e_y (Bloesch et al. 2016).
Eigen::Vector3d direction(const Eigen::Quaterniond& q);
/// dn/dq, columns in Eigen's order x y z w.
Eigen::Matrix<double, 3, 4> direction_jacobian(const Eigen::Quaterniond& q);
Eigen::Quaterniond direction_plus(const Eigen::Quaterniond& q, const Eigen::Vector2d& u);
/// d(q [+] u)/du at u = 0, rows in Eigen's order x y z w.
Eigen::Matrix<double, 4, 2> direction_plus_jacobian(const Eigen::Quaterniond& q);
/// The u with y = x [+] u as directions.
Eigen::Vector2d direction_minus(const Eigen::Quaterniond& y, const Eigen::Quaterniond& x);

}  // namespace gpo
