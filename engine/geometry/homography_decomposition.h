// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// One reading of a Euclidean homography H' ~ R_21 (I - tau n^T), |n| = 1, n.x < 0 for visible
/// points (the signs of engine/method.md, eq. 4; frame 1 -> frame 2).
struct HomographyMotion {
  Eigen::Matrix3d R_21;
  Eigen::Vector3d tau;     ///< in frame 1, in units of the plane's distance
  Eigen::Vector3d normal;  ///< in frame 1
};

/// Returns all motions behind x_2 ~ H x_1 (rays; any scale and sign of H), possible or not: the
/// true one and its twin, each also as (-n, -tau), in this order: a, -a, b, -b. Analytic, no SVD
/// (Malis & Vargas 2007, INRIA RR-6303; OpenCV has the same).
///
/// Degenerate cases: a rotation alone (|tau| below about 5e-4) gives no motion, as any plane would
/// do; where the camera moves along the normal, two singular values coincide and so do the true
/// motion and its twin, each accurate to the square root of the error of H. A singular or
/// non-finite H gives no motion.
std::vector<HomographyMotion> decompose_homography(const Eigen::Matrix3d& H);

/// How many of the points the motion puts behind a camera or onto the plane's far side. Rays of
/// frame 1, 3 x n.
int points_behind(const HomographyMotion& motion, const Eigen::Matrix3Xd& rays_1);

/// The physically possible motions (at most two) behind p_2 ~ H p_1: those that have all of the
/// points in front of both cameras. `visible_px` are points of frame 1, 2 x n.
std::vector<HomographyMotion> decompose_homography(const Eigen::Matrix3d& H,
                                                   const Eigen::Matrix3d& K,
                                                   const Eigen::Matrix2Xd& visible_px);

}  // namespace gpo
