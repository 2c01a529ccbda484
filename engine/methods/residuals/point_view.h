// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

/// K and its inverse, undistorted image [px].
struct Intrinsics {
  Eigen::Matrix3d K;
  Eigen::Matrix3d K_inverse;
};

/// Projection of a point of the reference frame to frame i, with derivatives. The point is x_1 /
/// rho with the ray x_1 = K^-1 (u v 1)^T of its reference pixel and the inverse depth rho (Civera
/// et al. 2008), which also represents points at infinity: y = R_ciw (x_1 - rho p_wci),  p = pi(K
/// y).
struct PointView {
  Eigen::Vector2d pixel;                   ///< undistorted [px]
  Eigen::Matrix<double, 2, 4> d_rotation;  ///< dp/dq of R_wci, Eigen's order x y z w [px]
  Eigen::Matrix<double, 2, 3> d_position;  ///< dp/dp_wci [px]
  Eigen::Matrix2d d_pixel_1;               ///< dp/d(u, v)
  Eigen::Vector2d d_inverse_depth;         ///< dp/drho [px]
  bool in_front = false;                   ///< y_z > 0
};

PointView view_point(const Intrinsics& intrinsics,
                     const Eigen::Quaterniond& q_wci,
                     const Eigen::Vector3d& p_wci,
                     const Eigen::Vector2d& pixel_1,
                     double inverse_depth);

/// Inverse depth on the plane n.P + 1 = 0, rho = -n.x_1, with derivatives.
struct PlaneDepth {
  double inverse_depth;
  Eigen::RowVector3d d_normal;
  Eigen::RowVector2d d_pixel_1;  ///< [1/px]
};

PlaneDepth depth_on_plane(const Intrinsics& intrinsics,
                          const Eigen::Vector3d& normal,
                          const Eigen::Vector2d& pixel_1);

}  // namespace gpo
