// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo {

/// Camera pose in a world: x_w = R_wc x_c + p_wc.
struct Pose {
  Eigen::Matrix3d R_wc = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_wc = Eigen::Vector3d::Zero();  ///< camera center [unit of the world]
};

/// T_ac = T_ab * T_bc.
Pose operator*(const Pose& T_ab, const Pose& T_bc);
Pose inverse(const Pose& pose);
Eigen::Vector3d to_world(const Pose& pose, const Eigen::Vector3d& point_c);
Eigen::Vector3d to_camera(const Pose& pose, const Eigen::Vector3d& point_w);

/// Returns the rotation matrix of a rotation vector [rad] (Rodrigues).
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_rad);
/// Returns the rotation vector [rad] of a rotation matrix, norm in [0, pi].
Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);
/// Returns J with exp(v + dv) ~ exp(v) exp(J dv) (Forster et al., "On-Manifold Preintegration",
/// eq. 8).
Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& rotation_rad);
/// Returns [v]x, with [v]x w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);
/// Returns the angle between two vectors, accurate near 0 and pi [deg].
double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
double radians(double degrees);
double degrees(double radians);

/// Motion of a camera around the time stamp of a frame, to second order, in its axes there:
/// exp(t w + t^2 / 2 w'), t v + t^2 / 2 a.
struct RowMotion {
  Eigen::Vector3d rotation_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rad_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation_s = Eigen::Vector3d::Zero();   ///< [unit of the world / s]
  Eigen::Vector3d translation_s2 = Eigen::Vector3d::Zero();  ///< [unit of the world / s^2]
};

/// x_a = scale * R_ab * x_b + t_ab.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d R_ab = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_ab = Eigen::Vector3d::Zero();
};

Eigen::Vector3d operator*(const Similarity& T_ab, const Eigen::Vector3d& x_b);

/// The part of a similarity that a set of points determines. ok: all of it; line: all but the
/// rotation about the line; point: only a translation.
enum class Alignment { ok, line, point };

/// Returns the least-squares similarity that maps `from` onto `to` (Umeyama 1991). Both 3 x n,
/// n >= 1.
Similarity align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// Classifies the extent of a path by the standard deviations s1 >= s2 along its principal axes: a
/// point if s1 < 1e-3 `reference_length` (e.g. the plane distance), a line if s2 < 2 % of s1.
Alignment determined_alignment(const Eigen::Matrix3Xd& path, double reference_length);

}  // namespace gpo
