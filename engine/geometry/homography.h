// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

Eigen::Vector2d transfer(const Eigen::Matrix3d& H, const Eigen::Vector2d& x);

/// Normalized DLT (Hartley & Zisserman, alg. 4.2), n >= 4; nullopt if degenerate or flipped.
std::optional<Eigen::Matrix3d> fit_homography(const Eigen::Matrix2Xd& from,
                                              const Eigen::Matrix2Xd& to);

/// In a tenth of `fit_homography`'s time; not finite if three of the points are collinear.
Eigen::Matrix3d homography_through_four(const Eigen::Matrix<double, 2, 4>& from,
                                        const Eigen::Matrix<double, 2, 4>& to);

/// Gauss-Newton on the one-sided transfer error sum |to - pi(H from)|^2. Scaled to H_33 = 1.
Eigen::Matrix3d refine_homography(const Eigen::Matrix3d& H,
                                  const Eigen::Matrix2Xd& from,
                                  const Eigen::Matrix2Xd& to);

/// A decomposition of H' ~ R_21 (I - tau n^T), |n| = 1, n.x < 0 (engine/method.md, eq. 4).
struct HomographyMotion {
  Eigen::Matrix3d R_21;
  Eigen::Vector3d tau;     ///< in frame 1 [distance of the plane]
  Eigen::Vector3d normal;  ///< in frame 1
};

/// Returns all decompositions of x_2 ~ H x_1, feasible or not: the true one, its twin, and both as
/// (-n, -tau) (Malis & Vargas 2007, INRIA RR-6303). None for a singular H or a pure rotation (|tau|
/// below about 5e-4); for a motion along the normal both coincide with half the digits.
std::vector<HomographyMotion> decompose_homography(const Eigen::Matrix3d& H);

/// Counts points behind a camera or on the far side of the plane. `rays_1` of frame 1, 3 x n.
int points_behind(const HomographyMotion& motion, const Eigen::Matrix3Xd& rays_1);

/// Returns the feasible decompositions of p_2 ~ H p_1, at most two. `visible_px` of frame 1, 2 x n.
std::vector<HomographyMotion> decompose_homography(const Eigen::Matrix3d& H,
                                                   const Eigen::Matrix3d& K,
                                                   const Eigen::Matrix2Xd& visible_px);

}  // namespace gpo
