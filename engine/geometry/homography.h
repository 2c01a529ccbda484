// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

/// Returns pi(H x), the transferred point. NaN or infinite for a point at infinity.
Eigen::Vector2d transfer(const Eigen::Matrix3d& H, const Eigen::Vector2d& x);

/// Fits the homography to ~ H from with the least algebraic error (normalized DLT, Hartley &
/// Zisserman, alg. 4.2), oriented so that the points keep a positive third coordinate. Both 2 x n,
/// n >= 4; nullopt if the points are degenerate or H flips some of them.
std::optional<Eigen::Matrix3d> fit_homography(const Eigen::Matrix2Xd& from,
                                              const Eigen::Matrix2Xd& to);

/// Returns the homography through four correspondences, in a tenth of `fit_homography`'s time; not
/// finite if three of them are collinear.
Eigen::Matrix3d homography_through_four(const Eigen::Matrix<double, 2, 4>& from,
                                        const Eigen::Matrix<double, 2, 4>& to);

/// Refines H by Gauss-Newton on the one-sided transfer error sum |to - pi(H from)|^2. Scaled to
/// H_33 = 1.
Eigen::Matrix3d refine_homography(const Eigen::Matrix3d& H,
                                  const Eigen::Matrix2Xd& from,
                                  const Eigen::Matrix2Xd& to);

/// One decomposition of a Euclidean homography H' ~ R_21 (I - tau n^T), |n| = 1, n.x < 0 for
/// visible points (signs of engine/method.md, eq. 4; frame 1 -> frame 2).
struct HomographyMotion {
  Eigen::Matrix3d R_21;
  Eigen::Vector3d tau;     ///< in frame 1 [distance of the plane]
  Eigen::Vector3d normal;  ///< in frame 1
};

/// Returns all decompositions of x_2 ~ H x_1 (rays; any scale and sign of H), feasible or not, in
/// the order a, -a, b, -b: the true one and its twin, each also as (-n, -tau). Analytic, no SVD
/// (Malis & Vargas 2007, INRIA RR-6303; same result as OpenCV).
///
/// Degenerate cases: a pure rotation (|tau| below about 5e-4), a singular or a non-finite H give no
/// decomposition. If the camera moves along the normal, two singular values coincide and so do the
/// true motion and its twin, each accurate to the square root of the error of H.
std::vector<HomographyMotion> decompose_homography(const Eigen::Matrix3d& H);

/// Returns the number of points that the motion puts behind a camera or on the far side of the
/// plane. `rays_1` of frame 1, 3 x n.
int points_behind(const HomographyMotion& motion, const Eigen::Matrix3Xd& rays_1);

/// Returns whether a motion that puts `behind` of `count` points behind a camera is feasible: at
/// most 2 %, because noise moves points of a grazing plane over its horizon.
bool is_feasible(int behind, int count);

/// Returns the feasible decompositions of p_2 ~ H p_1, at most two. `visible_px` are points of
/// frame 1, 2 x n.
std::vector<HomographyMotion> decompose_homography(const Eigen::Matrix3d& H,
                                                   const Eigen::Matrix3d& K,
                                                   const Eigen::Matrix2Xd& visible_px);

}  // namespace gpo
