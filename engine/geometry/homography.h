// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

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

}  // namespace gpo
