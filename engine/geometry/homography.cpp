// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography.h"

#include "engine/geometry/decompositions.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Returns the similarity that centers the points at a mean distance of sqrt(2).
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
/// to first order the weighted squares of p - pi(H x); with w = 1 those of the DLT rows.
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

/// A homography with all elements of H^T H - I below this is a rotation (OpenCV's value).
constexpr double kRotationOnly = 1e-3;
/// Largest share of the points that a feasible motion puts behind a camera.
constexpr double kMostBehind = 0.02;

double root(double x) { return std::sqrt(std::max(x, 0.0)); }

/// Scales H to a middle singular value of 1 and det H > 0; nullopt for a singular H or a rotation.
std::optional<Matrix3d> unit_homography(const Matrix3d& H) {
  if (!H.allFinite()) return std::nullopt;
  const Vector3d d = Eigen::JacobiSVD<Matrix3d>(H).singularValues();
  if (!(d(2) > 1e-9 * d(0))) return std::nullopt;
  const Matrix3d unit = H / (H.determinant() > 0 ? d(1) : -d(1));
  const Matrix3d S = unit.transpose() * unit - Matrix3d::Identity();
  if (S.cwiseAbs().maxCoeff() < kRotationOnly) return std::nullopt;
  return unit;
}

/// H = R (I + t n^T), (I + t n^T)^-1 = I - t n^T / (1 + n.t); adds both signs of (n, tau).
void add_motions(std::vector<HomographyMotion>& motions,
                 const Matrix3d& H,
                 const Vector3d& t,
                 const Vector3d& n) {
  const Matrix3d R_21 = H * (Matrix3d::Identity() - t * n.transpose() / (1 + n.dot(t)));
  const double length = n.norm();
  motions.push_back({R_21, -t * length, n / length});
  motions.push_back({R_21, t * length, -n / length});
}

/// Negated cofactors of S = H^T H - I; on the diagonal Malis & Vargas' opposites of minors, >= 0.
Matrix3d opposite_cofactors(const Matrix3d& S) {
  Matrix3d M;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // Rows other than i and columns other than j, in cyclic order, which includes (-1)^(i+j).
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      M(i, j) = S(a, d) * S(b, c) - S(a, c) * S(b, d);
    }
  }
  return M;
}

std::vector<HomographyMotion> malis_vargas(const Matrix3d& H) {
  const Matrix3d S = H.transpose() * H - Matrix3d::Identity();
  const Matrix3d M = opposite_cofactors(S);
  // The row of the largest diagonal element s_kk is best conditioned: n = (s_k + e) / |.|.
  int k = 0;
  S.diagonal().cwiseAbs().maxCoeff(&k);
  const int p = (k + 1) % 3;
  const int q = (k + 2) % 3;
  Vector3d e = Vector3d::Zero();
  e(p) = root(M(q, q));
  e(q) = M(p, q) >= 0 ? -root(M(p, p)) : root(M(p, p));
  const Vector3d n_a = (S.col(k) + e).normalized();
  const Vector3d n_b = (S.col(k) - e).normalized();
  const double nu = 2 * root(1 + S.trace() - M.trace());
  const double rho = std::sqrt(2 + S.trace() + nu);
  const double t = root(2 + S.trace() - nu);  // |t|
  const double sign = S(k, k) >= 0 ? 1 : -1;
  std::vector<HomographyMotion> motions;
  add_motions(motions, H, t / 2 * (sign * rho * n_b - t * n_a), n_a);
  add_motions(motions, H, t / 2 * (sign * rho * n_a - t * n_b), n_b);
  return motions;
}

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

std::vector<HomographyMotion> decompose_homography(const Matrix3d& H) {
  const auto unit = unit_homography(H);
  return unit ? malis_vargas(*unit) : std::vector<HomographyMotion>{};
}

int points_behind(const HomographyMotion& motion, const Eigen::Matrix3Xd& rays_1) {
  // The point x / -n.x (the plane at distance 1) is at x / -n.x + tau from the second camera.
  const Eigen::RowVector3d forward = motion.R_21.row(2);
  int behind = 0;
  for (const auto& ray : rays_1.colwise()) {
    const double depth_1 = -1 / motion.normal.dot(ray);
    const double depth_2 = forward.dot((ray * depth_1 + motion.tau).transpose());
    behind += depth_1 > 0 && depth_2 > 0 ? 0 : 1;
  }
  return motion.normal.dot(motion.tau) < 1 ? behind : static_cast<int>(rays_1.cols());
}

bool is_feasible(int behind, int count) { return behind <= kMostBehind * count; }

std::vector<HomographyMotion> decompose_homography(const Matrix3d& H,
                                                   const Matrix3d& K,
                                                   const Matrix2Xd& visible_px) {
  const Matrix3d K_inverse = K.inverse();
  const Eigen::Matrix3Xd rays = K_inverse * visible_px.colwise().homogeneous();
  auto motions = decompose_homography(K_inverse * H * K);
  const auto count = static_cast<int>(rays.cols());
  std::erase_if(motions, [&](const HomographyMotion& motion) {
    return !is_feasible(points_behind(motion, rays), count);
  });
  return motions;
}

}  // namespace gpo
