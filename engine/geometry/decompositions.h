// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

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

}  // namespace gpo
