// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera_resection.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/sqpnp.h"
#include "engine/geometry/statistics.h"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

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

/// R_wc <- R_wc exp(w), p_wc <- p_wc + R_wc v, of least squared error of the points within
/// `most_px`; (w, v).
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
    Eigen::Matrix<double, 2, 3> d_y;  // of the pixel
    d_y << 1, 0, -x.x(), 0, 1, -x.y();
    d_y = K.topLeftCorner<2, 2>() * d_y / y.z();
    Eigen::Matrix<double, 2, 6> J;
    J << d_y * skew(y), -d_y;  // y <- exp(-w) (y - v)
    JtJ += J.transpose() * J;
    Jtr += J.transpose() * r;
  }
  return solve_symmetric(JtJ, -Jtr);
}

}  // namespace

std::optional<Resection> refine_pose(const Pose& start,
                                     const Eigen::Matrix3Xd& points_w,
                                     const Eigen::Matrix2Xd& pixels,
                                     const Matrix3d& K) {
  if (points_w.cols() < kLeastPoints) return std::nullopt;
  Pose pose = start;
  for (int step = 0; step < 20; ++step) {
    const double median_px = median(errors_px(pose, points_w, pixels, K));
    if (!std::isfinite(median_px)) return std::nullopt;
    // A hundredth of a pixel more, so that rounding rejects nothing where there is no noise.
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
  const std::optional<Pose> start = pose_of_least_algebraic_error(points_w, seen);
  if (!start) return std::nullopt;
  return refine_pose(*start, points_w, pixels, K);
}

}  // namespace gpo
