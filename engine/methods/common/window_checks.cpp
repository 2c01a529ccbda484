// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/window_checks.h"

#include "engine/geometry/statistics.h"
#include "engine/geometry/transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;

/// A rotation leaves at least this multiple of the homography's error where there is parallax.
constexpr double kParallaxToNoise = 2;
/// The same in pixels: below it, lens and rolling shutter explain as much as parallax does.
constexpr double kLeastParallaxPx = 0.5;
/// A right solution leaves at most this multiple of the homographies' error, and so many pixels
/// more: rotations are given and may be off by half a degree.
constexpr double kDistrustFactor = 5;
constexpr double kDistrustPx = 5;

/// Stray tracks; more beyond the horizon make the plane a wrong one.
constexpr double kMostBeyond = 0.05;

}  // namespace

std::optional<std::string> reason_not_to_try(const Window& window) {
  if (window.track_count() < kLeastInliers) {
    return fmt::format(
        "too few tracks: {} are seen in frame {}, where the window starts, at least {} are needed",
        window.track_count(),
        window.start,
        kLeastInliers);
  }
  if (window.inliers == Inliers::planes && window.planes.empty()) {
    return fmt::format(
        "no plane: of {} tracks no set stands out that keeps to one homography a frame; the "
        "largest "
        "that was tried has {}",
        window.track_count(),
        window.largest_refused);
  }
  for (int i = 1; i < window.frame_count(); ++i) {
    const int inliers = window.inlier_count(i);
    if (inliers < kLeastInliers) {
      return fmt::format("too few inliers: frame {} has {}, at least {} are needed",
                         window.start + i,
                         inliers,
                         kLeastInliers);
    }
  }
  FrameErrors widest;
  double least_px = 0;
  const std::vector<FrameErrors> of_frames = frame_errors(window);
  for (int i = 1; i < window.frame_count(); ++i) {
    const FrameErrors& errors = of_frames[i];
    least_px = std::max(kLeastParallaxPx, kParallaxToNoise * errors.homography_px);
    if (errors.rotation_px > least_px) return std::nullopt;
    if (errors.rotation_px > widest.rotation_px) widest = errors;
  }
  return fmt::format(
      "no parallax: a pure rotation explains every frame to {:.2f} px (homography: {:.2f} px); "
      "move the camera sideways",
      widest.rotation_px,
      widest.homography_px);
}

std::vector<double> reprojection_errors_px(const Window& window,
                                           const Plane& plane,
                                           std::span<const Pose> cameras) {
  const Matrix3d K_inverse = window.K.inverse();
  std::vector<double> errors;
  for (int i = 1; i < window.frame_count(); ++i) {
    const Matrix3d R_cw = cameras[i].R_wc.transpose();
    const FrameState state{.R_cw = R_cw,
                           .tau_c = -(R_cw * cameras[i].p_wc) / plane.distance,
                           .normal = plane.normal,
                           .fx = window.K(0, 0),
                           .fy = window.K(1, 1)};
    for (int j = 0; j < window.track_count(); ++j) {
      if (!window.inlier[i][j]) continue;
      const Eigen::Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
      const Transfer seen = transfer_on_plane(state, ray_1);
      const Eigen::Vector2d pixel = seen.pixel + window.K.topRightCorner<2, 1>();
      errors.push_back(seen.in_front() ? (pixel - window.points_px[i].col(j)).norm()
                                       : std::numeric_limits<double>::infinity());
    }
  }
  return errors;
}

std::vector<double> reprojection_errors_px(const Window& window,
                                           std::span<const Pose> cameras,
                                           std::span<const MapPoint> points) {
  std::vector<double> errors;
  for (int i = 0; i < window.frame_count(); ++i) {
    for (const auto& [track, position] : points) {
      if (!window.inlier[i][track]) continue;
      const Eigen::Vector3d seen = window.K * to_camera(cameras[i], position);
      errors.push_back(seen.z() > 0 ? (seen.hnormalized() - window.points_px[i].col(track)).norm()
                                    : std::numeric_limits<double>::infinity());
    }
  }
  return errors;
}

double noise_px(double summed_squares, double residuals, double unknowns) {
  return std::sqrt(summed_squares / std::max(1.0, residuals - unknowns));
}

std::optional<std::string> reason_to_distrust(const Window& window,
                                              const Plane& plane,
                                              std::span<const Pose> cameras) {
  const double expected_px = homography_error_px(window);
  const double found_px = median(reprojection_errors_px(window, plane, cameras));
  if (found_px > kDistrustFactor * expected_px + kDistrustPx) {
    return fmt::format(
        "no convergence to the plane: median residual {:.1f} px, where the homographies leave "
        "{:.1f} px "
        "(wrong minimum, or rotations that do not fit the pictures)",
        found_px,
        expected_px);
  }
  const std::vector<int> beyond = beyond_horizon(window, plane);
  if (static_cast<double>(beyond.size()) > kMostBeyond * window.inlier_count(0)) {
    return fmt::format(
        "wrong minimum: the plane's horizon runs through the points ({} of {} lie beyond it, the "
        "first is track {})",
        beyond.size(),
        window.inlier_count(0),
        beyond.front());
  }
  return std::nullopt;
}

std::vector<int> beyond_horizon(const Window& window, const Plane& plane) {
  const Matrix3d K_inverse = window.K.inverse();
  std::vector<int> beyond;
  for (int j = 0; j < window.track_count(); ++j) {
    const Eigen::Vector3d ray = K_inverse * window.points_px[0].col(j).homogeneous();
    if (window.inlier[0][j] && !(plane.normal.dot(ray) < 0)) beyond.push_back(j);
  }
  return beyond;
}

Initialization trusted(const Window& window, Initialization result) {
  if (auto reason = reason_to_distrust(window, result.plane, result.cameras))
    return refused(*reason, std::move(result));
  result.ok = true;
  return result;
}

}  // namespace gpo
