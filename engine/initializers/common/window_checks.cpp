// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/common/window_checks.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/median.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;

/// A rotation leaves at least this multiple of the homography's error where there is parallax.
constexpr double kParallaxToNoise = 2;
/// The same in pixels: below it, lens and rolling shutter explain as much as parallax does.
constexpr double kLeastParallaxPx = 0.5;
/// A right solution leaves at most this multiple of the homographies' error, and so many pixels
/// more: rotations are given and may be off by half a degree.
constexpr double kDistrustFactor = 5;
constexpr double kDistrustPx = 5;

/// A frame's inliers in the reference picture and in its own [px].
struct Pairs {
  Matrix2Xd from, to;
};

Pairs inlier_pairs(const Window& window, int frame) {
  std::vector<int> inliers;
  for (int j = 0; j < window.track_count(); ++j) {
    if (window.inlier[frame][j]) inliers.push_back(j);
  }
  return {window.points_px[0](Eigen::all, inliers), window.points_px[frame](Eigen::all, inliers)};
}

std::vector<double> transfer_errors_px(const Matrix3d& H, const Pairs& pairs) {
  std::vector<double> errors;
  for (Eigen::Index k = 0; k < pairs.from.cols(); ++k)
    errors.push_back((transfer(H, pairs.from.col(k)) - pairs.to.col(k)).norm());
  return errors;
}

double sum_of_squares(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return sum;
}

}  // namespace

FrameErrors frame_errors(const Window& window, int frame) {
  const Pairs pairs = inlier_pairs(window, frame);
  const Matrix3d K_inverse = window.K.inverse();
  const Matrix3Xd rays_1 = (K_inverse * pairs.from.colwise().homogeneous()).colwise().normalized();
  const Matrix3Xd rays_i = (K_inverse * pairs.to.colwise().homogeneous()).colwise().normalized();
  const Matrix3d R_i1 = Eigen::umeyama(rays_1, rays_i, false).topLeftCorner<3, 3>();
  auto homography = transfer_errors_px(window.H_i1[frame], pairs);
  auto rotation = transfer_errors_px(window.K * R_i1 * K_inverse, pairs);
  FrameErrors errors{.inliers = static_cast<int>(homography.size())};
  errors.homography_squares = sum_of_squares(homography);
  errors.rotation_squares = sum_of_squares(rotation);
  errors.homography_px = median(std::move(homography));
  errors.rotation_px = median(std::move(rotation));
  return errors;
}

std::optional<std::string> reason_not_to_try(const Window& window) {
  if (window.track_count() < kLeastInliers) {
    return fmt::format(
        "too few tracks: {} are seen in frame {}, where the window starts, at least {} are needed",
        window.track_count(),
        window.start,
        kLeastInliers);
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
  for (int i = 1; i < window.frame_count(); ++i) {
    const FrameErrors errors = frame_errors(window, i);
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
    const Eigen::Vector3d tau = -cameras[i].p_wc / plane.distance;
    const Matrix3d KR = window.K * cameras[i].R_wc.transpose();
    for (int j = 0; j < window.track_count(); ++j) {
      if (!window.inlier[i][j]) continue;
      const Eigen::Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
      const Eigen::Vector3d seen = KR * (ray_1 - tau * plane.normal.dot(ray_1));
      errors.push_back(seen.z() > 0 ? (seen.hnormalized() - window.points_px[i].col(j)).norm()
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

double homography_error_px(const Window& window) {
  std::vector<double> errors;
  for (int i = 1; i < window.frame_count(); ++i)
    errors.push_back(median(transfer_errors_px(window.H_i1[i], inlier_pairs(window, i))));
  return median(std::move(errors));
}

double root_mean_square(std::span<const double> values) {
  return values.empty() ? 0
                        : std::sqrt(sum_of_squares(values) / static_cast<double>(values.size()));
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
  const Matrix3d K_inverse = window.K.inverse();
  for (int j = 0; j < window.track_count(); ++j) {
    const Eigen::Vector3d ray = K_inverse * window.points_px[0].col(j).homogeneous();
    if (window.inlier[0][j] && !(plane.normal.dot(ray) < 0)) {
      return fmt::format("wrong minimum: the plane's horizon runs through the points (track {})",
                         j);
    }
  }
  return std::nullopt;
}

}  // namespace gpo
