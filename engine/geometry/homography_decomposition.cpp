// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography_decomposition.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Elements of H^T H - I below which a homography is a rotation (OpenCV's number).
constexpr double kRotationOnly = 1e-3;

/// Square root of what rounding may have made negative.
double root(double x) { return std::sqrt(std::max(x, 0.0)); }

/// H with middle singular value 1 and det H > 0 (the cameras on one side of the plane); nothing for
/// a singular one or a rotation.
std::optional<Matrix3d> normalized(const Matrix3d& H) {
  if (!H.allFinite()) return std::nullopt;
  const Vector3d d = Eigen::JacobiSVD<Matrix3d>(H).singularValues();
  if (!(d(2) > 1e-9 * d(0))) return std::nullopt;
  const Matrix3d unit = H / (H.determinant() > 0 ? d(1) : -d(1));
  const Matrix3d S = unit.transpose() * unit - Matrix3d::Identity();
  if (S.cwiseAbs().maxCoeff() < kRotationOnly) return std::nullopt;
  return unit;
}

/// Appends a motion, and it once more with the other sign of (n, tau).
void add(std::vector<HomographyMotion>& motions,
         const Matrix3d& R_21,
         const Vector3d& tau,
         const Vector3d& normal) {
  const double length = normal.norm();
  motions.push_back({R_21, tau * length, normal / length});
  motions.push_back({R_21, -tau * length, -normal / length});
}

/// Appends H = R (I + t n^T), from which R follows by (I + t n^T)^-1 = I - t n^T / (1 + n.t).
void add_factored(std::vector<HomographyMotion>& motions,
                  const Matrix3d& H,
                  const Vector3d& t,
                  const Vector3d& n) {
  add(motions, H * (Matrix3d::Identity() - t * n.transpose() / (1 + n.dot(t))), -t, n);
}

/// Opposites of the cofactors of H^T H - I: >= 0 on the diagonal, where they are Malis & Vargas'
/// opposites of minors.
Matrix3d opposite_cofactors(const Matrix3d& S) {
  Matrix3d M;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // The rows but i, the columns but j, in cyclic order, which takes care of the sign (-1)^i+j.
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      M(i, j) = S(a, d) * S(b, c) - S(a, c) * S(b, d);
    }
  }
  return M;
}

std::vector<HomographyMotion> malis_vargas(const Matrix3d& H) {
  const Matrix3d S = H.transpose() * H - Matrix3d::Identity();
  const Matrix3d M = opposite_cofactors(S);
  // The row of the largest diagonal element s_kk is the best conditioned: n = (s_k + e) / |.|.
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

std::vector<HomographyMotion> faugeras(const Matrix3d& H) {
  const Eigen::JacobiSVD<Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double d1 = svd.singularValues()(0);
  const double d3 = svd.singularValues()(2);
  const double x1 = root((d1 * d1 - 1) / (d1 * d1 - d3 * d3));
  const double x3 = root((1 - d3 * d3) / (d1 * d1 - d3 * d3));
  std::vector<HomographyMotion> motions;
  for (const double side : {1.0, -1.0}) {  // d' = side * d_2
    for (const double sign : {1.0, -1.0}) {
      // In the axes of the SVD: diag(d) = d' R + t n^T.
      const Vector3d n(x1, 0, sign * x3);
      const Vector3d t = (d1 - side * d3) * Vector3d(x1, 0, -side * sign * x3);
      const double sine = (d1 - side * d3) * sign * x1 * x3;
      const double cosine = d3 * x1 * x1 + side * d1 * x3 * x3;
      Matrix3d R;
      R << cosine, 0, -side * sine, 0, side, 0, sine, 0, side * cosine;
      const Matrix3d R_21 = svd.matrixU() * R * svd.matrixV().transpose();
      const Vector3d tau = -side * (svd.matrixV() * R.transpose() * t);
      add(motions, R_21, tau, svd.matrixV() * n);
    }
  }
  return motions;
}

std::vector<HomographyMotion> zhang(const Matrix3d& H) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(H.transpose() * H);
  const double l1 = root(eigen.eigenvalues()(2));
  const double l3 = root(eigen.eigenvalues()(0));
  const double difference = l1 - l3;
  const double product = l1 * l3;
  const double ratio = std::sqrt(1 + 4 * product / (difference * difference));
  const double zeta1 = (-1 + ratio) / (2 * product);
  const double zeta3 = (-1 - ratio) / (2 * product);
  const auto length = [&](double zeta) {
    return root(zeta * zeta * difference * difference + 2 * zeta * (product - 1) + 1);
  };
  const Vector3d v1 = length(zeta1) * eigen.eigenvectors().col(2);
  const Vector3d v3 = length(zeta3) * eigen.eigenvectors().col(0);
  std::vector<HomographyMotion> motions;
  for (const double sign : {1.0, -1.0}) {
    const Vector3d t = (v1 - sign * v3) / (zeta1 - zeta3);
    const Vector3d n = (zeta1 * sign * v3 - zeta3 * v1) / (zeta1 - zeta3);
    add_factored(motions, H, t, n);
  }
  return motions;
}

}  // namespace

const char* key_of(Decomposition algorithm) {
  return algorithm == Decomposition::malis_vargas ? "malis_vargas"
         : algorithm == Decomposition::faugeras   ? "faugeras"
                                                  : "zhang";
}

const char* title_of(Decomposition algorithm) {
  return algorithm == Decomposition::malis_vargas ? "Malis-Vargas"
         : algorithm == Decomposition::faugeras   ? "Faugeras"
                                                  : "Zhang";
}

std::vector<HomographyMotion> decompose_homography(const Matrix3d& H, Decomposition algorithm) {
  const auto unit = normalized(H);
  if (!unit) return {};
  if (algorithm == Decomposition::faugeras) return faugeras(*unit);
  return algorithm == Decomposition::zhang ? zhang(*unit) : malis_vargas(*unit);
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
  auto motions = decompose_homography(K_inverse * H * K, Decomposition::malis_vargas);
  std::erase_if(motions, [&](const auto& motion) { return points_behind(motion, rays) > 0; });
  return motions;
}

}  // namespace gpo
