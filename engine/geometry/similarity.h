// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo {

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
