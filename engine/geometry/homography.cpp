// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography.h"

#include "engine/geometry/decompositions.h"

#include <cmath>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Returns the similarity that moves the centroid to the origin and scales the mean distance from
/// it to sqrt(2).
Matrix3d normalization(const Matrix2Xd& x) {
  const Vector2d mean = x.rowwise().mean();
  const double spread = (x.colwise() - mean).colwise().norm().mean();
  const double scale = spread > 0 ? std::sqrt(2.0) / spread : 1.0;
  Matrix3d T;
  T << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return T;
}

Vector2d normalized(const Matrix3d& T, const Vector2d& x) {
  return T(0, 0) * x + T.topRightCorner<2, 1>();
}

/// The quadratic form sum w Q (x) x x^T over the rows of H, Q = [1 0 -u; 0 1 -v; -u -v u^2 + v^2]:
/// to first order the weighted squares of p - pi(H x); with w = 1 those of the two DLT rows
/// (x, 0, -u x) and (0, x, -v x).
class LinearForm {
 public:
  void add(const Vector3d& x, const Vector2d& p, double w) {
    const Matrix3d xx = w * x * x.transpose();
    of_1_ += xx;
    of_u_ += p.x() * xx;
    of_v_ += p.y() * xx;
    of_pp_ += p.squaredNorm() * xx;
  }
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd A(9, 9);
    A << of_1_, Matrix3d::Zero(), -of_u_, Matrix3d::Zero(), of_1_, -of_v_, -of_u_, -of_v_, of_pp_;
    return A;
  }

 private:
  Matrix3d of_1_ = Matrix3d::Zero(), of_u_ = Matrix3d::Zero(), of_v_ = Matrix3d::Zero(),
           of_pp_ = Matrix3d::Zero();
};

}  // namespace

Vector2d transfer(const Matrix3d& H, const Vector2d& x) {
  return (H * x.homogeneous()).hnormalized();
}

std::optional<Matrix3d> fit_homography(const Matrix2Xd& from, const Matrix2Xd& to) {
  const Matrix3d T_from = normalization(from);
  const Matrix3d T_to = normalization(to);
  LinearForm form;
  for (Eigen::Index j = 0; j < from.cols(); ++j)
    form.add(normalized(T_from, from.col(j)).homogeneous(), normalized(T_to, to.col(j)), 1);
  const SymmetricEigen eigen = symmetric_eigen(form.matrix());
  if (!(eigen.values(1) > 1e-12 * eigen.values(8))) return std::nullopt;
  const Eigen::VectorXd h = eigen.vectors.col(0);
  const Matrix3d Hn = h.reshaped<Eigen::RowMajor>(3, 3);
  Matrix3d H = T_to.inverse() * Hn * T_from;
  const Eigen::RowVectorXd depth = H.row(2) * from.colwise().homogeneous();
  if (depth(0) < 0) H = -H;
  const bool turned = (depth.array() * (depth(0) < 0 ? -1 : 1)).minCoeff() <= 0;
  if (turned || !H.allFinite() || !(std::abs(Hn.determinant()) > 1e-9)) return std::nullopt;
  return Matrix3d(H / H.norm());
}

Eigen::Matrix3d homography_through_four(const Eigen::Matrix<double, 2, 4>& from,
                                        const Eigen::Matrix<double, 2, 4>& to) {
  // The basis in which the first three points are the axes and the fourth is (1, 1, 1).
  const auto basis = [](const Eigen::Matrix<double, 2, 4>& x) -> Eigen::Matrix3d {
    const Eigen::Matrix3d three = x.leftCols<3>().colwise().homogeneous();
    return three * (three.inverse() * x.col(3).homogeneous()).asDiagonal();
  };
  return basis(to) * basis(from).inverse();
}

Matrix3d refine_homography(const Matrix3d& H_start, const Matrix2Xd& from, const Matrix2Xd& to) {
  const Matrix3d T_from = normalization(from);
  const Matrix3d T_to = normalization(to);
  Matrix3d H = T_to * H_start * T_from.inverse();
  H /= H(2, 2);
  for (int step = 0; step < 5; ++step) {
    LinearForm form;
    Matrix3d gradient = Matrix3d::Zero();
    for (Eigen::Index j = 0; j < from.cols(); ++j) {
      const Vector3d x = normalized(T_from, from.col(j)).homogeneous();
      const Vector3d y = H * x;
      const Vector2d p = y.hnormalized();
      const Vector2d r = p - normalized(T_to, to.col(j));
      form.add(x, p, 1 / (y.z() * y.z()));
      gradient += Vector3d(r.x(), r.y(), -p.dot(r)) * x.transpose() / y.z();
    }
    Eigen::VectorXd delta = Eigen::VectorXd::Zero(9);
    delta.head(8) = solve_symmetric(form.matrix().topLeftCorner(8, 8),
                                    -gradient.reshaped<Eigen::RowMajor>().head(8));
    if (!delta.allFinite()) break;
    H += delta.reshaped<Eigen::RowMajor>(3, 3);
    if (delta.norm() < 1e-10) break;
  }
  const Matrix3d refined = T_to.inverse() * H * T_from;
  return refined.allFinite() ? Matrix3d(refined / refined(2, 2)) : H_start;
}

}  // namespace gpo
