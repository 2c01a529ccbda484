// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

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

/// The homography that takes four points to four others, in a tenth of `fit_homography`'s time; not
/// finite where three of them are in a line.
Eigen::Matrix3d homography_through_four(const Eigen::Matrix<double, 2, 4>& from,
                                        const Eigen::Matrix<double, 2, 4>& to);

/// Gauss-Newton on the one-sided transfer error sum |to - pi(H from)|^2, starting from H. Scaled to
/// H_33 = 1.
Eigen::Matrix3d refine_homography(const Eigen::Matrix3d& H,
                                  const Eigen::Matrix2Xd& from,
                                  const Eigen::Matrix2Xd& to);

}  // namespace gpo
