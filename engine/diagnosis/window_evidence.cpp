// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/window_evidence.h"

#include "engine/geometry/homography.h"
#include "engine/methods/common/window_checks.h"

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

constexpr int kLeastTracksOfScene = 8;
constexpr double kOutlier = 2;  // lambda_3: upper limit of an error per constraint

/// Torr 1998: sum of bounded squared errors + lambda_1 d n + lambda_2 k, for n pairs of points (r =
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

/// Returns the distance of a pair from a homography with errors in both points, from the transfer
/// errors in both directions [px].
double symmetric_px(const Matrix3d& H,
                    const Matrix3d& H_inverse,
                    const Vector2d& x1,
                    const Vector2d& x2) {
  const double there = (transfer(H, x1) - x2).squaredNorm();
  const double back = (transfer(H_inverse, x2) - x1).squaredNorm();
  return std::sqrt(there * back / (there + back + std::numeric_limits<double>::min()));
}

}  // namespace

Matrix3d fundamental_matrix(const Matrix3d& K_inverse, const Pose& camera) {
  const Vector3d t = camera.R_wc.transpose() * camera.p_wc;
  return K_inverse.transpose() * skew(t) * camera.R_wc.transpose() * K_inverse;
}

double sampson_px(const Matrix3d& F, const Vector2d& p_0, const Vector2d& p_i) {
  const Vector3d line_i = F * p_0.homogeneous();
  const Vector3d line_0 = F.transpose() * p_i.homogeneous();
  const double slopes = line_i.head<2>().squaredNorm() + line_0.head<2>().squaredNorm();
  return std::abs(p_i.homogeneous().dot(line_i)) / std::sqrt(std::max(slopes, 1e-30));
}

void WindowEvidence::add(const FrameErrors& errors) {
  ++frames_;
  residuals_ += 2.0 * errors.inliers;
  homography_squares_ += errors.homography_squares;
  rotation_squares_ += errors.rotation_squares;
}

double WindowEvidence::noise_px() const {
  return gpo::noise_px(homography_squares_, residuals_, 8.0 * frames_);
}

double WindowEvidence::rotation_rms_px() const {
  return gpo::noise_px(rotation_squares_, residuals_, 3.0 * frames_);
}

WindowEvidence evidence_of(const Window& window) {
  WindowEvidence evidence;
  for (int i = 1; i < window.frame_count(); ++i) evidence.add(frame_errors(window, i));
  return evidence;
}

Verdict numbers_of(const WindowEvidence& evidence,
                   std::optional<double> normal_sigma_deg,
                   double largest_translation) {
  return {.normal_sigma_deg = normal_sigma_deg,
          .rotation_rms_px = evidence.rotation_rms_px(),
          .noise_px = evidence.noise_px(),
          .largest_translation = largest_translation};
}

Verdict window_numbers(const Window& window, const Initialization& result, Lens lens) {
  std::optional<double> sigma_deg;
  if (result.uncertainty) sigma_deg = normal_sigma_deg(*result.uncertainty, lens);
  double travel = 0;
  for (const Pose& camera : result.cameras) travel = std::max(travel, camera.p_wc.norm());
  Verdict numbers = numbers_of(evidence_of(window), sigma_deg, travel / result.plane.distance);
  numbers.scene = scene_of(window);
  numbers.criterion = scene_criterion(window, result.cameras, *numbers.noise_px);
  return numbers;
}

SceneKind scene_of(const Window& window) {
  if (window.inliers != Inliers::planes) return SceneKind::unknown;
  if (window.planes.empty()) return SceneKind::no_plane;
  return window.planes.size() == 1 ? SceneKind::one_plane : SceneKind::several_planes;
}

std::optional<SceneCriterion> scene_criterion(const Window& window,
                                              std::span<const Pose> cameras,
                                              double noise_px) {
  if (window.planes.empty()) return std::nullopt;
  const auto farthest =
      std::ranges::max_element(cameras, {}, [](const Pose& camera) { return camera.p_wc.norm(); });
  const auto frame = farthest - cameras.begin();
  const Pose& camera = *farthest;
  if (!(noise_px > 0) || !(camera.p_wc.norm() > 0)) return std::nullopt;
  const Matrix3d F = fundamental_matrix(window.K.inverse(), camera);
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
  if (tracks < kLeastTracksOfScene) return std::nullopt;
  return SceneCriterion{planes.value(8 * static_cast<int>(window.planes.size())),
                        free_points.value(7)};
}

}  // namespace gpo
