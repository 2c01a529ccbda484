// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo {

// Eigen's decompositions of matrices of any size, compiled once: each costs a compiler seconds.
// Where sizes are fixed and the time of running counts, its own are used.

/// Of a symmetric matrix; values ascending, vectors in columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// X with A X = B for a symmetric positive semidefinite A, by L D L^T.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& A);
/// x of least |A x - b|, by a rank-revealing QR decomposition.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace gpo
