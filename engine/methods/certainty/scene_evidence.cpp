// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/scene_evidence.h"

#include "engine/geometry/homography.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kLeastTracks = 8;
constexpr double kOutlier = 2;  // lambda_3: an error counts at most so much a constraint

/// Torr 1998: sum of bounded squared errors + lambda_1 d n + lambda_2 k, of n pairs of points (r =
/// 4 numbers each), structure of dimension d and k parameters.
class Gric {
 public:
  Gric(int dimension, double noise_px) : dimension_(dimension), noise_px_(noise_px) {}
  void add(double error_px) {
    const double e = error_px / noise_px_;
    errors_ += std::min(e * e, kOutlier * (kNumbers - dimension_));
    ++pairs_;
  }
  double value(int parameters) const {
    return errors_ + std::log(kNumbers) * dimension_ * pairs_ +
           std::log(kNumbers * pairs_) * parameters;
  }

 private:
  static constexpr double kNumbers = 4;
  int dimension_;
  double noise_px_;
  double pairs_ = 0;
  double errors_ = 0;
};

Vector2d image_of(const Matrix3d& F, const Vector2d& x) { return (F * x.homogeneous()).head<2>(); }

/// First-order distance of a pair from the epipolar geometry x2^T F x1 = 0 [px].
double sampson_px(const Matrix3d& F, const Vector2d& x1, const Vector2d& x2) {
  const double algebraic = x2.homogeneous().dot(F * x1.homogeneous());
  const double slope = image_of(F, x1).squaredNorm() + image_of(F.transpose(), x2).squaredNorm();
  return std::abs(algebraic) / std::sqrt(slope);
}

/// Distance of a pair from a homography, both points in error [px]: the transfer's, there and back,
/// each seen through the other's slope alike.
double symmetric_px(const Matrix3d& H,
                    const Matrix3d& H_inverse,
                    const Vector2d& x1,
                    const Vector2d& x2) {
  const double there = (transfer(H, x1) - x2).squaredNorm();
  const double back = (transfer(H_inverse, x2) - x1).squaredNorm();
  return std::sqrt(there * back / (there + back + std::numeric_limits<double>::min()));
}

int farthest_camera(std::span<const Pose> cameras) {
  const auto farther = [](const Pose& a, const Pose& b) { return a.p_wc.norm() < b.p_wc.norm(); };
  return static_cast<int>(std::ranges::max_element(cameras, farther) - cameras.begin());
}

}  // namespace

SceneKind scene_of(const Window& window) {
  if (window.inliers != Inliers::planes) return SceneKind::not_told;
  if (window.planes.empty()) return SceneKind::no_plane;
  return window.planes.size() == 1 ? SceneKind::one_plane : SceneKind::several_planes;
}

std::vector<PlaneEvidence> plane_evidence(const Window& window) {
  std::vector<PlaneEvidence> evidence;
  for (const WindowPlane& plane : window.planes) {
    evidence.push_back({static_cast<double>(plane.tracks.size()) / window.track_count(),
                        plane.image_share,
                        plane.stability});
  }
  return evidence;
}

std::optional<SceneCriterion> scene_criterion(const Window& window,
                                              std::span<const Pose> cameras,
                                              double noise_px) {
  if (window.planes.empty()) return std::nullopt;
  const int frame = farthest_camera(cameras);
  const Pose& camera = cameras[frame];
  if (!(noise_px > 0) || !(camera.p_wc.norm() > 0)) return std::nullopt;
  const Vector3d t = camera.R_wc.transpose() * camera.p_wc;
  Matrix3d t_cross;
  t_cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  const Matrix3d K_inverse = window.K.inverse();
  const Matrix3d F = K_inverse.transpose() * t_cross * camera.R_wc.transpose() * K_inverse;
  Gric planes(2, noise_px), free_points(3, noise_px);
  int tracks = 0;
  for (int j = 0; j < window.track_count(); ++j) {
    const Vector2d x1 = window.points_px[0].col(j);
    const Vector2d x2 = window.points_px[frame].col(j);
    if (!x1.allFinite() || !x2.allFinite()) continue;
    ++tracks;
    double nearest_px = std::numeric_limits<double>::infinity();
    for (const WindowPlane& plane : window.planes) {
      const Matrix3d& H = plane.H_i1[frame];
      if (H.allFinite()) nearest_px = std::min(nearest_px, symmetric_px(H, H.inverse(), x1, x2));
    }
    planes.add(nearest_px);
    free_points.add(sampson_px(F, x1, x2));
  }
  if (tracks < kLeastTracks) return std::nullopt;
  return SceneCriterion{planes.value(8 * static_cast<int>(window.planes.size())),
                        free_points.value(7)};
}

}  // namespace gpo
