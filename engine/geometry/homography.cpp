// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Moves the centroid to the origin and the mean distance from it to sqrt(2).
Matrix3d normalization(const Matrix2Xd& x) {
  const Vector2d mean = x.rowwise().mean();
  const double spread = (x.colwise() - mean).colwise().norm().mean();
  const double scale = spread > 0 ? std::sqrt(2.0) / spread : 1.0;
  Matrix3d T;
  T << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return T;
}

/// Two rows of the direct linear transform for each pair: to x (H from) = 0.
Eigen::Matrix<double, Eigen::Dynamic, 9> linear_system(const Matrix2Xd& from, const Matrix2Xd& to) {
  Eigen::Matrix<double, Eigen::Dynamic, 9> A(2 * from.cols(), 9);
  for (Eigen::Index j = 0; j < from.cols(); ++j) {
    const Eigen::RowVector3d x = from.col(j).homogeneous().transpose();
    A.row(2 * j) << x, Eigen::RowVector3d::Zero(), -to(0, j) * x;
    A.row(2 * j + 1) << Eigen::RowVector3d::Zero(), x, -to(1, j) * x;
  }
  return A;
}

}  // namespace

Vector2d transfer(const Matrix3d& H, const Vector2d& x) {
  return (H * x.homogeneous()).hnormalized();
}

std::optional<Matrix3d> fit_homography(const Matrix2Xd& from, const Matrix2Xd& to) {
  const Matrix3d T_from = normalization(from);
  const Matrix3d T_to = normalization(to);
  const auto normalized = [](const Matrix3d& T, const Matrix2Xd& x) -> Matrix2Xd {
    return (T * x.colwise().homogeneous()).colwise().hnormalized();
  };
  const auto A = linear_system(normalized(T_from, from), normalized(T_to, to));
  Eigen::Matrix<double, 9, 1> h;
  if (from.cols() == 4) {
    // The null space of a full-rank 8x9 system, some ten times faster than the SVD in RANSAC's
    // loop.
    const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 9, 8>> qr(A.transpose());
    if (qr.rank() < 8) return std::nullopt;
    h = qr.householderQ() * Eigen::Matrix<double, 9, 1>::Unit(8);
  } else {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(A.transpose() * A);
    if (!(eigen.eigenvalues()(1) > 1e-12 * eigen.eigenvalues()(8))) return std::nullopt;
    h = eigen.eigenvectors().col(0);
  }
  const Matrix3d Hn = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data());
  Matrix3d H = T_to.inverse() * Hn * T_from;
  const Eigen::RowVectorXd depth = H.row(2) * from.colwise().homogeneous();
  if (depth(0) < 0) H = -H;
  const bool turned = (depth.array() * (depth(0) < 0 ? -1 : 1)).minCoeff() <= 0;
  if (turned || !H.allFinite() || !(std::abs(Hn.determinant()) > 1e-9)) return std::nullopt;
  return Matrix3d(H / H.norm());
}

Eigen::Matrix3d homography_through_four(const Eigen::Matrix<double, 2, 4>& from,
                                        const Eigen::Matrix<double, 2, 4>& to) {
  // The basis in which the first three are the axes and the fourth is (1, 1, 1).
  const auto basis = [](const Eigen::Matrix<double, 2, 4>& x) -> Eigen::Matrix3d {
    const Eigen::Matrix3d three = x.leftCols<3>().colwise().homogeneous();
    return three * (three.inverse() * x.col(3).homogeneous()).asDiagonal();
  };
  return basis(to) * basis(from).inverse();
}

Matrix3d refine_homography(const Matrix3d& H_start, const Matrix2Xd& from, const Matrix2Xd& to) {
  using Vector8d = Eigen::Matrix<double, 8, 1>;
  const Matrix3d T_from = normalization(from);
  const Matrix3d T_to = normalization(to);
  Matrix3d H = T_to * H_start * T_from.inverse();
  H /= H(2, 2);
  for (int step = 0; step < 5; ++step) {
    Eigen::Matrix<double, 8, 8> JtJ = Eigen::Matrix<double, 8, 8>::Zero();
    Vector8d Jtr = Vector8d::Zero();
    for (Eigen::Index j = 0; j < from.cols(); ++j) {
      const Vector3d x = T_from * from.col(j).homogeneous();
      const Vector3d y = H * x;
      const Vector2d p = y.hnormalized();
      const Vector2d r = p - (T_to * to.col(j).homogeneous()).hnormalized();
      Eigen::Matrix<double, 2, 8> J;
      J << x.transpose(), Eigen::RowVector3d::Zero(), -p.x() * x.head<2>().transpose(),
          Eigen::RowVector3d::Zero(), x.transpose(), -p.y() * x.head<2>().transpose();
      J /= y.z();
      JtJ += J.transpose() * J;
      Jtr += J.transpose() * r;
    }
    const Vector8d delta = JtJ.ldlt().solve(-Jtr);
    if (!delta.allFinite()) break;
    Matrix3d D;
    D << delta(0), delta(1), delta(2), delta(3), delta(4), delta(5), delta(6), delta(7), 0;
    H += D;
    if (delta.norm() < 1e-10) break;
  }
  const Matrix3d refined = T_to.inverse() * H * T_from;
  return refined.allFinite() ? Matrix3d(refined / refined(2, 2)) : H_start;
}

}  // namespace gpo
