// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/window_checks.h"

#include "engine/base/error.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/camera_resection.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/statistics.h"
#include "engine/geometry/transfer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;

/// With parallax, a pure rotation leaves at least this multiple of the homography's error. In
/// simulated windows of a camera that only rotates the largest of a window is 1.04 to 1.12, with a
/// path of 4 % of the distance it is 2.3 to 28.
constexpr double kParallaxToNoise = 1.85;
/// The same in `pixel_unit`: below it, lens and rolling shutter can explain the error.
constexpr double kLeastParallaxPx = 0.5;
/// A correct solution leaves at most this multiple of the homographies' error plus this many
/// `pixel_unit`, because given rotations may be off by half a degree.
constexpr double kDistrustFactor = 5;
constexpr double kDistrustPx = 5;
/// Largest share of stray tracks beyond the horizon; more mean a wrong plane.
constexpr double kMostBeyond = 0.05;
constexpr double kBehindCamera = std::numeric_limits<double>::infinity();

std::optional<std::string> reason_to_distrust(const Window& window,
                                              const Plane& plane,
                                              std::span<const Pose> cameras) {
  const double found_px = median(reprojection_errors_px(window, plane, cameras));
  if (found_px > most_residual_px(window)) {
    return fmt::format(
        "no convergence to the plane: median residual {:.1f} px, but {:.1f} px for the "
        "homographies "
        "(wrong minimum, or rotations that do not fit the images)",
        found_px,
        homography_error_px(window));
  }
  const std::vector<int> beyond = beyond_horizon(window, plane);
  if (static_cast<double>(beyond.size()) > kMostBeyond * window.inlier_count(0)) {
    return fmt::format(
        "wrong minimum: the plane's horizon runs through the points ({} of {} are beyond it, the "
        "first is track {})",
        beyond.size(),
        window.inlier_count(0),
        beyond.front());
  }
  return std::nullopt;
}

void check_size(const char* name, std::size_t found, std::size_t expected) {
  if (found != expected)
    throw InputError(fmt::format("window: {} {}, expected {}", found, name, expected));
}

void check_inliers(const std::vector<std::vector<bool>>& inlier, const Window& window) {
  check_size("frames of inliers", inlier.size(), window.points_px.size());
  for (const auto& of_frame : inlier)
    check_size("inlier marks in a frame", of_frame.size(), window.track_count());
}

/// Checks what indices rely on.
void check_window(const Window& window) {
  const std::size_t frames = window.points_px.size();
  if (frames == 0) throw InputError("window: no frames");
  if (!window.K.allFinite() || !(window.K(0, 0) > 0) || !(window.K(1, 1) > 0))
    throw InputError("window: K is not finite, or a focal length is not above 0");
  const auto check_points = [&](const std::vector<Eigen::Matrix2Xd>& points) {
    check_size("frames of points", points.size(), frames);
    for (const Eigen::Matrix2Xd& of_frame : points)
      check_size("tracks in a frame", of_frame.cols(), window.track_count());
  };
  check_points(window.points_px);
  for (const auto& moves : window.lens_moves_px) check_points(moves);
  check_inliers(window.inlier, window);
  check_size("homographies", window.H_i1.size(), frames);
  check_size("rotations", window.R_wc.size(), frames);
  if (window.gyro && window.gyro->d_bias.size() < frames)
    check_size("derivatives by the bias", window.gyro->d_bias.size(), frames);
  if (window.gyro && window.gyro->time_offset_sigma_s > 0)
    for (const auto& derivatives : {window.gyro->d_offset, window.gyro->d2_offset})
      if (derivatives.size() < frames)
        check_size("derivatives by the time offset", derivatives.size(), frames);
  for (const WindowPlane& plane : window.planes) {
    check_size("homographies of a plane", plane.H_i1.size(), frames);
    check_inliers(plane.inlier, window);
    for (const int track : plane.tracks)
      if (track < 0 || track >= window.track_count())
        throw InputError(fmt::format("window: a plane has track {}, which does not exist", track));
  }
  if (window.leader < 0 || (window.leader > 0 && window.leader >= std::ssize(window.planes)))
    throw InputError(fmt::format("window: leader {} is no plane", window.leader));
}

/// Returns the number of tracks in the reference frame without those that were left out.
int seen_tracks(const Window& window) {
  const Eigen::Array<bool, 2, Eigen::Dynamic> seen = window.points_px[0].array().isFinite();
  return static_cast<int>(seen.colwise().all().count());
}

}  // namespace

std::optional<std::string> reason_not_to_try(const Window& window) {
  check_window(window);
  const int tracks = seen_tracks(window);
  if (tracks < kLeastInliers) {
    return fmt::format(
        "too few tracks: frame {}, the first of the window, has {}, at least {} are needed",
        window.start,
        tracks,
        kLeastInliers);
  }
  if (window.inliers == Inliers::planes && window.planes.empty()) {
    return fmt::format(
        "no plane: no set of the {} tracks agrees with one homography per frame; the largest "
        "candidate has {}",
        tracks,
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
  const double least_px = kLeastParallaxPx * pixel_unit(window);
  FrameErrors widest;
  for (int i = 1; i < window.frame_count(); ++i) {
    const FrameErrors errors = frame_errors(window, i);
    if (errors.rotation_px > std::max(least_px, kParallaxToNoise * errors.homography_px))
      return std::nullopt;
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
    for (const int j : window.inlier_tracks(i)) {
      const Eigen::Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
      const Transfer seen = transfer_on_plane(state, ray_1);
      const Eigen::Vector2d pixel = seen.pixel + window.K.topRightCorner<2, 1>();
      errors.push_back(seen.in_front() ? (pixel - window.points_px[i].col(j)).norm()
                                       : kBehindCamera);
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
                                    : kBehindCamera);
    }
  }
  return errors;
}

std::optional<Eigen::Vector3d> triangulated_track(const Window& window,
                                                  std::span<const std::optional<Pose>> given,
                                                  int track) {
  if (!window.inlier[0][track]) return std::nullopt;
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<Pose> cameras;
  Eigen::Matrix3Xd rays(3, window.frame_count());
  for (int i = 0; i < window.frame_count(); ++i) {
    if (!given[i] || !window.inlier[i][track]) continue;
    rays.col(std::ssize(cameras)) = K_inverse * window.points_px[i].col(track).homogeneous();
    cameras.push_back(*given[i]);
  }
  if (cameras.size() < 2) return std::nullopt;
  return triangulate(cameras, rays.leftCols(std::ssize(cameras)));
}

std::vector<MapPoint> triangulated(const Window& window,
                                   std::span<const std::optional<Pose>> given) {
  std::vector<MapPoint> points;
  for (int j = 0; j < window.track_count(); ++j)
    if (const auto point = triangulated_track(window, given, j)) points.push_back({j, *point});
  return points;
}

void set_fit_errors(const Window& window, Initialization& result) {
  const auto rms_px = [](std::vector<double> errors_px) -> std::optional<double> {
    std::erase_if(errors_px, [](double error_px) { return !std::isfinite(error_px); });
    if (errors_px.empty()) return std::nullopt;
    return root_mean_square(errors_px);
  };
  result.transfer_rms_px = rms_px(reprojection_errors_px(window, result.plane, result.cameras));
  result.reprojection_rms_px =
      rms_px(reprojection_errors_px(window, result.cameras, result.points));
}

double noise_px(double summed_squares, double residuals, double unknowns) {
  return std::sqrt(summed_squares / std::max(1.0, residuals - unknowns));
}

std::vector<int> beyond_horizon(const Window& window, const Plane& plane) {
  const Matrix3d K_inverse = window.K.inverse();
  std::vector<int> beyond;
  for (const int j : window.inlier_tracks(0)) {
    const Eigen::Vector3d ray = K_inverse * window.points_px[0].col(j).homogeneous();
    if (!(plane.normal.dot(ray) < 0)) beyond.push_back(j);
  }
  return beyond;
}

double most_residual_px(const Window& window) {
  return kDistrustFactor * homography_error_px(window) + kDistrustPx * pixel_unit(window);
}

Initialization trusted(const Window& window, Initialization result) {
  if (auto reason = reason_to_distrust(window, result.plane, result.cameras))
    return refused(*reason, std::move(result));
  result.ok = true;
  return result;
}

Initialization refined_start(const Window& window,
                             const StartMethod& start,
                             Refinement refine,
                             const Watch& watch) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  Initialization started = start.initialize(window, watch);
  if (started.stopped) return started;
  Initialization result = started.ok
                              ? refine(window, started, watch)
                              : failed(fmt::format("start by {}: {}", start.title, started.reason));
  result.candidates = started.candidates;
  return result;
}

}  // namespace gpo
