// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

/// pi(H x): where the homography takes a point. NaN or infinite for a point at infinity.
Eigen::Vector2d transfer(const Eigen::Matrix3d& H, const Eigen::Vector2d& x);

/// Least algebraic error homography with to ~ H from (normalized DLT, Hartley & Zisserman,
/// alg. 4.2), oriented so that the points keep a positive third coordinate. Both 2 x n, n >= 4;
/// nothing where the points do not determine it or it turns some of them around.
std::optional<Eigen::Matrix3d> fit_homography(const Eigen::Matrix2Xd& from,
                                              const Eigen::Matrix2Xd& to);

/// Gauss-Newton on the one-sided transfer error sum |to - pi(H from)|^2, starting from H. Scaled to
/// H_33 = 1.
Eigen::Matrix3d refine_homography(const Eigen::Matrix3d& H,
                                  const Eigen::Matrix2Xd& from,
                                  const Eigen::Matrix2Xd& to);

/// One reading of a Euclidean homography H' ~ R_21 (I - tau n^T), |n| = 1, n.x < 0 for visible
/// points (method.md's signs; frame 1 -> frame 2).
struct HomographyMotion {
  Eigen::Matrix3d R_21;
  Eigen::Vector3d tau;     ///< in frame 1, in units of the plane's distance
  Eigen::Vector3d normal;  ///< in frame 1
};

/// The physically possible motions (at most two) behind p_2 ~ H p_1: Malis-Vargas decomposition
/// (OpenCV's), candidates with points behind the camera dropped. `visible_px` are points of frame
/// 1, 2 x n.
std::vector<HomographyMotion> decompose_homography(const Eigen::Matrix3d& H,
                                                   const Eigen::Matrix3d& K,
                                                   const Eigen::Matrix2Xd& visible_px);

}  // namespace gpo
