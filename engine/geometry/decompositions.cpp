// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/decompositions.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace gpo {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& A) {
  return solve_symmetric(A, Eigen::MatrixXd::Identity(A.rows(), A.cols()));
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.colPivHouseholderQr().solve(b);
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

std::optional<Eigen::Matrix3d> rotation_meant(const Eigen::Matrix3d& M, double most_skew) {
  constexpr double kRounding = 1e-12;
  const double skew = (M * M.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew <= most_skew) || M.determinant() < 0) return std::nullopt;
  return skew <= kRounding ? M : nearest_rotation(M);
}

// Eigen's FromTwoVectors gives the same, but takes six seconds to compile.
Eigen::Quaterniond rotation_from_z_axis(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  if (d.z() < -1 + 1e-12) return {0, -1, 0, 0};  // half a turn
  const double s = std::sqrt((1 + d.z()) * 2);
  const double inverse = 1 / s;
  return {s * 0.5, (0 - d.y()) * inverse, d.x() * inverse, 0};
}

}  // namespace gpo
