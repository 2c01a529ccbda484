// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/sqpnp.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/nearest_rotation.h"

#include <algorithm>
#include <limits>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Matrix39 = Eigen::Matrix<double, 3, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;  ///< a matrix, row by row

/// Eigenvectors to start from: as many as points on a plane leave without a cost.
constexpr int kStarts = 4;
constexpr int kMostSteps = 60;
constexpr double kSettled_rad = 1e-9;
constexpr double kFirstDamping = 1e-4;
constexpr double kMostDamping = 1e8;

/// sum |B_k (R X_k + t)|^2 with the rows (1, 0, -x) and (0, 1, -y) of B, over r = R row by row, at
/// the best t = `translation` r.
struct Cost {
  Matrix9 form = Matrix9::Zero();
  Matrix39 translation = Matrix39::Zero();
};

Vector9 vector_of(const Matrix3d& M) { return M.reshaped<Eigen::RowMajor>(); }

Matrix3d matrix_of(const Vector9& r) { return r.reshaped<Eigen::RowMajor>(3, 3); }

Cost cost_of(const Eigen::Matrix3Xd& points, const Eigen::Matrix2Xd& seen) {
  Matrix9 rr = Matrix9::Zero();
  Matrix39 tr = Matrix39::Zero();
  Matrix3d tt = Matrix3d::Zero();
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    const Vector3d X = points.col(k);
    const double u = seen(0, k);
    const double v = seen(1, k);
    Matrix3d Q;  // B^T B
    Q << 1, 0, -u, 0, 1, -v, -u, -v, u * u + v * v;
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j)
        rr.block<3, 3>(3 * i, 3 * j) += Q(i, j) * X * X.transpose();
      tr.block<3, 3>(0, 3 * i) += Q.col(i) * X.transpose();
    }
    tt += Q;
  }
  Cost cost;
  cost.translation = -tt.inverse() * tr;
  cost.form = rr + tr.transpose() * cost.translation;
  return cost;
}

double value(const Cost& cost, const Matrix3d& R) {
  const Vector9 r = vector_of(R);
  return r.dot(cost.form * r);
}

/// Levenberg-Marquardt over R exp(w).
Matrix3d minimized(const Cost& cost, Matrix3d R) {
  double damping = kFirstDamping;
  double least = value(cost, R);
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    Eigen::Matrix<double, 9, 3> d_r;
    for (int k = 0; k < 3; ++k) d_r.col(k) = vector_of(R * skew(Vector3d::Unit(k)));
    Matrix3d JtJ = d_r.transpose() * cost.form * d_r;
    JtJ.diagonal().array() += damping * JtJ.trace();
    const Vector3d w = solve_symmetric(JtJ, -d_r.transpose() * (cost.form * vector_of(R)));
    if (!w.allFinite()) break;
    const Matrix3d moved = nearest_rotation(R * so3_exp(w));
    const double moved_to = value(cost, moved);
    if (moved_to < least) {
      R = moved;
      least = moved_to;
      damping /= 10;
    } else {
      damping *= 10;
    }
    if (w.norm() < kSettled_rad) break;
  }
  return R;
}

/// Whether most points are before the camera.
bool sees(const Matrix3d& R_cw, const Vector3d& t_cw, const Eigen::Matrix3Xd& points_w) {
  const Eigen::Index in_front = ((R_cw.row(2) * points_w).array() + t_cw.z() > 0).count();
  return 2 * in_front > points_w.cols();
}

}  // namespace

std::optional<Pose> pose_of_least_algebraic_error(const Eigen::Matrix3Xd& points_w,
                                                  const Eigen::Matrix2Xd& seen) {
  // Around their middle, so that rounding does not take the place of what tells the rotation.
  const Vector3d middle = points_w.rowwise().mean();
  const Eigen::Matrix3Xd points = points_w.colwise() - middle;
  const Cost cost = cost_of(points, seen);
  if (!cost.form.allFinite()) return std::nullopt;
  const SymmetricEigen eigen = symmetric_eigen(cost.form);
  std::optional<Pose> best;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kStarts; ++k) {
    for (const double sign : {1.0, -1.0}) {
      const Matrix3d start = nearest_rotation(sign * matrix_of(eigen.vectors.col(k)));
      const Matrix3d R_cw = minimized(cost, start);
      const Vector3d t_cw = cost.translation * vector_of(R_cw);
      const double found = value(cost, R_cw);
      if (!(found < least) || !sees(R_cw, t_cw, points)) continue;
      least = found;
      best = Pose{R_cw.transpose(), middle - R_cw.transpose() * t_cw};
    }
  }
  return best;
}

}  // namespace gpo
