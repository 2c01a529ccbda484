// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <cstdint>
#include <optional>

namespace gpo {

/// The plane normal . P + distance = 0 with |normal| = 1. By convention distance > 0: the normal
/// points to the side of the origin.
struct Plane {
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  double distance = 1;  ///< from the origin [unit of the frame]
};

/// Returns the same plane with its normal towards the origin.
Plane facing_origin(const Plane& plane);

/// Returns the plane in the camera frame (not flipped).
Plane plane_in_camera(const Plane& plane_w, const Pose& pose);

/// Returns an orthonormal basis of the tangent space of the unit sphere at `normal`.
Eigen::Matrix<double, 3, 2> normal_tangents(const Eigen::Vector3d& normal);

/// Returns the intersection of the plane and the ray from the camera center along `ray_c` (camera
/// frame), in the world; nullopt if they do not meet in front of the camera.
std::optional<Eigen::Vector3d> intersect(const Plane& plane_w,
                                         const Pose& pose,
                                         const Eigen::Vector3d& ray_c);

/// Fits a plane to points (3 x n) by 3-point RANSAC and total least squares over the inliers, which
/// are within 2 % of the median distance of the points; the normal points towards the origin.
/// nullopt for fewer than 3 points or if all are on a line.
std::optional<Plane> fit_plane(const Eigen::Matrix3Xd& points, std::uint64_t seed = 1);

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
