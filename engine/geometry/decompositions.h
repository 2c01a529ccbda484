// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

// Eigen's decompositions of dynamic matrices, compiled once, as each costs seconds.

struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& A);
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Returns the rotation with the least |R - M| (Frobenius norm), never a reflection.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M);

/// The rotation meant by few digits, M itself if exact; nullopt if it is off by `most_skew`.
std::optional<Eigen::Matrix3d> rotation_meant(const Eigen::Matrix3d& M, double most_skew);

Eigen::Quaterniond rotation_from_z_axis(const Eigen::Vector3d& direction);

}  // namespace gpo
