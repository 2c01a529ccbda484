// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

namespace gpo {

/// x_a = scale * R_ab * x_b + t_ab.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d R_ab = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_ab = Eigen::Vector3d::Zero();
};

Eigen::Vector3d operator*(const Similarity& T_ab, const Eigen::Vector3d& x_b);

/// What a set of points determines of a similarity: all of it; all but the rotation about its line;
/// nothing but a translation.
enum class Alignment { ok, line, point };

/// Least-squares similarity that maps `from` onto `to` (Umeyama 1991).
/// Both 3 x n, n >= 1.
Similarity align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// Extent of a path, judged by the standard deviations s1 >= s2 along its principal axes: a point
/// where s1 < 1e-3 of `reference_length` (say the distance of the plane), a line where s2 < 2 % of
/// s1.
Alignment determined_alignment(const Eigen::Matrix3Xd& path, double reference_length);

}  // namespace gpo
