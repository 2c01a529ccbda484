// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography_decomposition.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A homography with all elements of H^T H - I below this is a rotation (OpenCV's value).
constexpr double kRotationOnly = 1e-3;

/// Square root of a value that rounding may have made negative.
double root(double x) { return std::sqrt(std::max(x, 0.0)); }

/// Scales H to a middle singular value of 1 and det H > 0 (both cameras on one side of the plane);
/// nullopt for a singular H or a rotation.
std::optional<Matrix3d> normalized(const Matrix3d& H) {
  if (!H.allFinite()) return std::nullopt;
  const Vector3d d = Eigen::JacobiSVD<Matrix3d>(H).singularValues();
  if (!(d(2) > 1e-9 * d(0))) return std::nullopt;
  const Matrix3d unit = H / (H.determinant() > 0 ? d(1) : -d(1));
  const Matrix3d S = unit.transpose() * unit - Matrix3d::Identity();
  if (S.cwiseAbs().maxCoeff() < kRotationOnly) return std::nullopt;
  return unit;
}

/// Appends a motion with both signs of (n, tau).
void add(std::vector<HomographyMotion>& motions,
         const Matrix3d& R_21,
         const Vector3d& tau,
         const Vector3d& normal) {
  const double length = normal.norm();
  motions.push_back({R_21, tau * length, normal / length});
  motions.push_back({R_21, -tau * length, -normal / length});
}

/// Appends the motion of H = R (I + t n^T), with (I + t n^T)^-1 = I - t n^T / (1 + n.t).
void add_factored(std::vector<HomographyMotion>& motions,
                  const Matrix3d& H,
                  const Vector3d& t,
                  const Vector3d& n) {
  add(motions, H * (Matrix3d::Identity() - t * n.transpose() / (1 + n.dot(t))), -t, n);
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
  add_factored(motions, H, t / 2 * (sign * rho * n_b - t * n_a), n_a);
  add_factored(motions, H, t / 2 * (sign * rho * n_a - t * n_b), n_b);
  return motions;
}

}  // namespace

std::vector<HomographyMotion> decompose_homography(const Matrix3d& H) {
  const auto unit = normalized(H);
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

std::vector<HomographyMotion> decompose_homography(const Matrix3d& H,
                                                   const Matrix3d& K,
                                                   const Eigen::Matrix2Xd& visible_px) {
  const Matrix3d K_inverse = K.inverse();
  const Eigen::Matrix3Xd rays = K_inverse * visible_px.colwise().homogeneous();
  auto motions = decompose_homography(K_inverse * H * K);
  std::erase_if(motions, [&](const auto& motion) { return points_behind(motion, rays) > 0; });
  return motions;
}

}  // namespace gpo
