// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera_resection.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Matrix39 = Eigen::Matrix<double, 3, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;  ///< a matrix, row by row

/// Eigenvectors to start from: the dimension of the null space for coplanar points.
constexpr int kStarts = 4;
constexpr int kMostSteps = 60;
constexpr double kSettled_rad = 1e-9;
constexpr double kFirstDamping = 1e-4;
constexpr double kMostDamping = 1e8;

/// sum |B_k (R X_k + t)|^2 with the rows (1, 0, -x) and (0, 1, -y) of B, as a quadratic form of
/// r = R row by row, at the best t = `translation` r.
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
  return vector_of(R).dot(cost.form * vector_of(R));
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

bool sees(const Matrix3d& R_cw, const Vector3d& t_cw, const Eigen::Matrix3Xd& points_w) {
  const Eigen::Index in_front = ((R_cw.row(2) * points_w).array() + t_cw.z() > 0).count();
  return 2 * in_front > points_w.cols();
}

constexpr int kLeastPoints = 4;

/// Reprojection errors [px], infinite behind the camera.
std::vector<double> errors_px(const Pose& pose,
                              const Eigen::Matrix3Xd& points_w,
                              const Eigen::Matrix2Xd& pixels,
                              const Matrix3d& K) {
  std::vector<double> errors;
  for (Eigen::Index k = 0; k < points_w.cols(); ++k) {
    const Vector3d y = K * to_camera(pose, points_w.col(k));
    errors.push_back(y.z() > 0 ? (y.hnormalized() - pixels.col(k)).norm()
                               : std::numeric_limits<double>::infinity());
  }
  return errors;
}

/// Returns the step (w, v) of R_wc exp(w), p_wc + R_wc v over points with errors up to `most_px`.
Eigen::Matrix<double, 6, 1> gauss_newton_step(const Pose& pose,
                                              const Eigen::Matrix3Xd& points_w,
                                              const Eigen::Matrix2Xd& pixels,
                                              const Matrix3d& K,
                                              double most_px) {
  Eigen::Matrix<double, 6, 6> JtJ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> Jtr = Eigen::Matrix<double, 6, 1>::Zero();
  for (Eigen::Index k = 0; k < points_w.cols(); ++k) {
    const Vector3d y = to_camera(pose, points_w.col(k));
    if (!(y.z() > 0)) continue;
    const Vector2d x = y.hnormalized();
    const Vector2d r = K.topLeftCorner<2, 2>() * x + K.topRightCorner<2, 1>() - pixels.col(k);
    if (r.norm() > most_px) continue;
    Eigen::Matrix<double, 2, 3> d_y;  // dp/dy
    d_y << 1, 0, -x.x(), 0, 1, -x.y();
    d_y = K.topLeftCorner<2, 2>() * d_y / y.z();
    Eigen::Matrix<double, 2, 6> J;
    J << d_y * skew(y), -d_y;  // y <- exp(-w) (y - v)
    JtJ += J.transpose() * J;
    Jtr += J.transpose() * r;
  }
  return solve_symmetric(JtJ, -Jtr);
}

/// Returns the point with the least summed squared distance; nullopt if the rays are parallel.
std::optional<Vector3d> nearest_to_rays(std::span<const Pose> cameras,
                                        const Eigen::Matrix3Xd& rays) {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Vector3d ray_w = (cameras[i].R_wc * rays.col(static_cast<int>(i))).normalized();
    const Matrix3d across = Matrix3d::Identity() - ray_w * ray_w.transpose();
    A += across;
    b += across * cameras[i].p_wc;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(A);
  if (!(eigen.eigenvalues()(0) > 1e-10 * eigen.eigenvalues()(2))) return std::nullopt;
  return A.ldlt().solve(b);
}

}  // namespace

std::optional<Pose> solve_sqpnp(const Eigen::Matrix3Xd& points_w, const Eigen::Matrix2Xd& seen) {
  // Centering keeps rounding errors small compared with the points' extent.
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

std::optional<Resection> refine_pose(const Pose& start,
                                     const Eigen::Matrix3Xd& points_w,
                                     const Eigen::Matrix2Xd& pixels,
                                     const Matrix3d& K) {
  if (points_w.cols() < kLeastPoints) return std::nullopt;
  Pose pose = start;
  for (int step = 0; step < 20; ++step) {
    const double median_px = median(errors_px(pose, points_w, pixels, K));
    if (!std::isfinite(median_px)) return std::nullopt;
    // 0.01 px more, so that rounding rejects no point of noise-free data.
    const double most_px = 3 * median_px / kMedianOfRayleigh + 0.01;
    const auto delta = gauss_newton_step(pose, points_w, pixels, K, most_px);
    if (!delta.allFinite()) return std::nullopt;
    pose.p_wc += pose.R_wc * delta.tail<3>();
    pose.R_wc = pose.R_wc * so3_exp(delta.head<3>());
    if (delta.norm() < 1e-10) break;
  }
  pose.R_wc = Eigen::Quaterniond(pose.R_wc).normalized().toRotationMatrix();
  const double median_px = median(errors_px(pose, points_w, pixels, K));
  if (!std::isfinite(median_px)) return std::nullopt;
  return Resection{pose, median_px};
}

std::optional<Resection> resect_camera(const Eigen::Matrix3Xd& points_w,
                                       const Eigen::Matrix2Xd& pixels,
                                       const Matrix3d& K) {
  if (points_w.cols() < kLeastPoints) return std::nullopt;
  const Eigen::Matrix2Xd seen =
      (K.inverse() * pixels.colwise().homogeneous()).colwise().hnormalized();
  const std::optional<Pose> start = solve_sqpnp(points_w, seen);
  if (!start) return std::nullopt;
  return refine_pose(*start, points_w, pixels, K);
}

std::optional<Resection> follow_camera(const Pose& before,
                                       const Eigen::Matrix3Xd& points_w,
                                       const Eigen::Matrix2Xd& pixels,
                                       const Matrix3d& K) {
  const auto followed = refine_pose(before, points_w, pixels, K);
  const auto anew = resect_camera(points_w, pixels, K);
  if (!followed || !anew) return followed ? followed : anew;
  return anew->median_px < followed->median_px ? anew : followed;
}

std::optional<Vector3d> triangulate(std::span<const Pose> cameras, const Eigen::Matrix3Xd& rays) {
  auto point = nearest_to_rays(cameras, rays);
  for (int step = 0; point && step < 5; ++step) {
    Matrix3d JtJ = Matrix3d::Zero();
    Vector3d Jtr = Vector3d::Zero();
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const Vector3d y = to_camera(cameras[i], *point);
      if (!(y.z() > 0)) return std::nullopt;
      Eigen::Matrix<double, 2, 3> d_y;  // dx/dy
      d_y << 1, 0, -y.x() / y.z(), 0, 1, -y.y() / y.z();
      const Eigen::Matrix<double, 2, 3> J = d_y * cameras[i].R_wc.transpose() / y.z();
      JtJ += J.transpose() * J;
      Jtr += J.transpose() * (y.hnormalized() - rays.col(static_cast<int>(i)).head<2>());
    }
    const Vector3d delta = JtJ.ldlt().solve(-Jtr);
    if (!delta.allFinite()) return std::nullopt;
    *point += delta;
    if (delta.norm() < 1e-12 * point->norm()) break;
  }
  const auto in_front = [&](const Pose& camera) { return to_camera(camera, *point).z() > 0; };
  return point && std::ranges::all_of(cameras, in_front) ? point : std::nullopt;
}

double parallax_deg(std::span<const Pose> cameras, const Vector3d& point_w) {
  double largest = 0;
  for (const Pose& camera : cameras.subspan(1)) {
    const double angle = angle_deg(point_w - cameras.front().p_wc, point_w - camera.p_wc);
    largest = std::max(largest, angle);
  }
  return largest;
}

}  // namespace gpo
