// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

/// Returns the rotation with the least |R - M| (Frobenius norm), never a reflection.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M);

/// Returns the rotation that a matrix written with few digits approximates; M itself if it is one
/// up to rounding. nullopt if an entry of M M^T is off by more than `most_skew` or M is a
/// reflection.
std::optional<Eigen::Matrix3d> rotation_meant(const Eigen::Matrix3d& M, double most_skew);

/// Returns the smallest rotation from the z axis to `direction`. Compiled once, because Eigen's
/// FromTwoVectors instantiates an SVD.
Eigen::Quaterniond rotation_from_z_axis(const Eigen::Vector3d& direction);

}  // namespace gpo
