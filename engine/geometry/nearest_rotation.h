// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

/// The rotation with the least |R - M| (Frobenius); of a matrix that mirrors the nearest that does
/// not.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M);

/// The rotation that a matrix written with few digits is meant to be: as it is where it is one but
/// for rounding; nothing where an entry of M M^T is off by more than `most_skew`, or where M
/// mirrors.
std::optional<Eigen::Matrix3d> rotation_meant(const Eigen::Matrix3d& M, double most_skew);

/// Returns the smallest rotation that takes the z axis to `direction`. Compiled once: Eigen's
/// FromTwoVectors brings a singular value decomposition with it.
Eigen::Quaterniond rotation_from_z_axis(const Eigen::Vector3d& direction);

}  // namespace gpo
