// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

// Eigen's decompositions of dynamic matrices, compiled once: each costs seconds of compilation.
// Code with fixed sizes that must be fast calls Eigen directly.

/// Eigenvalues of a symmetric matrix, ascending, and its eigenvectors in columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// Solves A X = B for a symmetric positive semidefinite A by LDL^T.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& A);
/// Returns the x with the least |A x - b|, by rank-revealing QR.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Returns the rotation with the least |R - M| (Frobenius norm), never a reflection.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M);

/// Returns the rotation that a matrix written with few digits approximates; M itself if it is one
/// up to rounding. nullopt if an entry of M M^T is off by more than `most_skew` or M is a
/// reflection.
std::optional<Eigen::Matrix3d> rotation_meant(const Eigen::Matrix3d& M, double most_skew);

/// Returns the smallest rotation from the z axis to `direction`: within 1.5e-6 rad where that is
/// almost opposite, otherwise to rounding.
Eigen::Quaterniond rotation_from_z_axis(const Eigen::Vector3d& direction);

}  // namespace gpo
