// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/geometry/camera_resection.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/plane.h"
#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"
#include "engine/methods/plane/plane_result.h"

#include <algorithm>
#include <limits>

#include <Eigen/LU>
#include <Eigen/QR>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector3d;

constexpr int kLeastLocatingPoints = 8;
constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

/// Returns the points of all planes with an estimate, from the positions in the reference frame.
std::vector<MapPoint> points_of_planes(const Inspection& inspection) {
  const Window& window = *inspection.window;
  std::vector<MapPoint> points;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.points_px[0].col(j).allFinite()) continue;
    const auto number =
        window.is_inlier_track(j) ? std::optional(window.leader) : window.plane_of(j);
    const Plane* plane = number ? estimated_plane(inspection, *number) : nullptr;
    if (plane == nullptr) continue;
    const Eigen::Vector2d raw_px = inspection.tracks->raw_px[0].col(j);
    if (const auto point = point_on_plane(inspection, 0, raw_px, *plane))
      points.push_back({j, *point});
  }
  return points;
}

/// Returns the tracks of the window and of the frames after it; null if stopped.
std::shared_ptr<const Tracks> longer_tracks(const Inspection& inspection,
                                            int frames,
                                            const std::stop_token& stop,
                                            const Progress& progress) {
  const Recording& recording = *inspection.recording;
  const FrameSpan span{inspection.window->start, frames};
  if (!recording.tracks.empty()) return chosen_tracks(recording, span).tracks;
  const auto followed =
      followed_tracks(recording, span, inspection.settings.tracking, stop, progress);
  return followed ? followed->tracks : nullptr;
}

/// Returns the undistorted positions in a frame; NaN: not seen, or not in the window.
Matrix2Xd undistorted(const Inspection& inspection, const Tracks& tracks, int frame) {
  const Camera& camera = inspection.recording->camera;
  Matrix2Xd points_px = Matrix2Xd::Constant(2, tracks.track_count(), kUnseen);
  for (int j = 0; j < tracks.track_count(); ++j)
    if (tracks.seen(frame, j) && inspection.window->points_px[0].col(j).allFinite())
      points_px.col(j) = undistort(camera, tracks.raw_px[frame].col(j));
  return points_px;
}

/// A frame after the window and its points.
struct LaterFrame {
  ExtrapolatedCamera camera;
  Matrix2Xd points_px;
  RowMotion motion;
};

/// Poses and times of successive frames.
struct Path {
  std::vector<Pose> poses;
  std::vector<std::int64_t> timestamps_ns;
};

/// Returns the velocity at the end of a path by a parabola through its last poses; zero with fewer
/// than three. With so few poses that each decides, its errors would grow from frame to frame.
RowMotion motion_at_end(const Path& path) {
  constexpr std::size_t kMostPoses = 7;
  const std::size_t count = std::min(kMostPoses, path.poses.size());
  if (count < 3) return {};
  const Pose& last = path.poses.back();
  Eigen::MatrixXd powers(count, 3), values(count, 6);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = path.poses.size() - count + k;
    const double seconds =
        1e-9 * static_cast<double>(path.timestamps_ns[i] - path.timestamps_ns.back());
    const auto row = static_cast<Eigen::Index>(k);
    powers.row(row) << 1, seconds, seconds * seconds;
    values.row(row) << so3_log(last.R_wc.transpose() * path.poses[i].R_wc).transpose(),
        (last.R_wc.transpose() * (path.poses[i].p_wc - last.p_wc)).transpose();
  }
  const Eigen::MatrixXd fit = powers.householderQr().solve(values);
  return {.rotation_rad_s = fit.row(1).head<3>(), .translation_s = fit.row(1).tail<3>()};
}

/// Moves undistorted pixels to where the points would have been seen at the time stamp.
Matrix2Xd at_time_stamp(const RollingCamera& camera,
                        const Pose& pose,
                        const Eigen::Matrix3Xd& points_w,
                        Matrix2Xd pixels) {
  if (camera.row_delay_s == 0) return pixels;
  const Eigen::Matrix3d K = intrinsic_matrix(camera.camera);
  for (Eigen::Index k = 0; k < pixels.cols(); ++k) {
    const Vector3d point_c = to_camera(pose, points_w.col(k));
    const Vector3d at_row =
        to_camera(pose_at_row(camera, distort(camera.camera, pixels.col(k))), point_c);
    pixels.col(k) += (K * point_c).hnormalized() - (K * at_row).hnormalized();
  }
  return pixels;
}

/// Follows the camera to the next frame; its motion and the rows' delay depend on each other.
std::optional<Resection> follow_rolling(const Path& path,
                                        std::int64_t timestamp_ns,
                                        const Eigen::Matrix3Xd& points_w,
                                        const Matrix2Xd& pixels,
                                        RollingCamera& camera) {
  constexpr int kRounds = 3;
  const Eigen::Matrix3d K = intrinsic_matrix(camera.camera);
  auto found = follow_camera(path.poses.back(), points_w, pixels, K);
  for (int round = 0; round < kRounds && found && camera.row_delay_s != 0; ++round) {
    Path longer = path;
    longer.poses.push_back(found->pose);
    longer.timestamps_ns.push_back(timestamp_ns);
    camera.motion = motion_at_end(longer);
    found = follow_camera(
        found->pose, points_w, at_time_stamp(camera, found->pose, points_w, pixels), K);
  }
  return found;
}

/// Locates a frame's camera. Throws InputError with the reason if it cannot be located.
LaterFrame locate(const Inspection& inspection,
                  const std::vector<MapPoint>& points,
                  const Path& path,
                  std::int64_t timestamp_ns,
                  Matrix2Xd points_px) {
  const Eigen::Matrix3d& K = inspection.window->K;
  std::vector<int> seen;
  for (int k = 0; k < std::ssize(points); ++k)
    if (points_px.col(points[k].track).allFinite()) seen.push_back(k);
  const auto count = static_cast<int>(seen.size());
  if (count < kLeastLocatingPoints)
    throw InputError(fmt::format("{} of the planes seen, at least {} are needed",
                                 counted(count, "point"),
                                 kLeastLocatingPoints));
  Eigen::Matrix3Xd points_w(3, count);
  Matrix2Xd pixels(2, count);
  for (int k = 0; k < count; ++k) {
    points_w.col(k) = points[seen[k]].position;
    pixels.col(k) = points_px.col(points[seen[k]].track);
  }
  RollingCamera camera{inspection.recording->camera};
  if (!inspection.row_motions.empty())
    camera.row_delay_s = inspection.initialization->row_delay_s.value_or(0);
  const auto found = follow_rolling(path, timestamp_ns, points_w, pixels, camera);
  if (!found) throw InputError("no camera has the points of the planes in front of it");
  pixels = at_time_stamp(camera, found->pose, points_w, std::move(pixels));
  const double threshold_px = inspection.window->threshold_px;
  int agreeing = 0;
  for (int k = 0; k < count; ++k) {
    const Vector3d seen_by = K * to_camera(found->pose, points_w.col(k));
    const double error_px = (seen_by.hnormalized() - pixels.col(k)).norm();
    agreeing += seen_by.z() > 0 && error_px <= threshold_px ? 1 : 0;
  }
  if (agreeing < kLeastLocatingPoints || 2 * agreeing < count)
    throw InputError(fmt::format("{} of {} of the planes agree within {:.1f} px",
                                 agreeing,
                                 counted(count, "point"),
                                 threshold_px));
  return {{.timestamp_ns = timestamp_ns,
           .pose = found->pose,
           .points = agreeing,
           .median_px = found->median_px},
          std::move(points_px),
          camera.motion};
}

/// Appends a frame to a window: its inliers agree with the homographies of planes and camera.
void append_frame(const Inspection& inspection, const LaterFrame& later, Window& window) {
  RollingCamera camera = rolling_camera(inspection, 0);
  camera.motion = later.motion;
  const auto error_px = [&](const Plane& plane, int track) {
    const auto point =
        point_on_plane(inspection, 0, inspection.tracks->raw_px[0].col(track), plane);
    if (!point) return std::numeric_limits<double>::infinity();
    const Eigen::Vector2d raw_px = project(camera, to_camera(later.camera.pose, *point));
    return (undistort(camera.camera, raw_px) - later.points_px.col(track)).norm();
  };
  const auto inliers_of = [&](const Plane& plane, const auto& candidate) {
    std::vector<bool> inlier(window.track_count(), false);
    for (int j = 0; j < window.track_count(); ++j)
      inlier[j] = candidate(j) && error_px(plane, j) <= window.threshold_px;
    return inlier;
  };
  const Eigen::Matrix3d H =
      homography_of(window, later.camera.pose, inspection.initialization->plane);
  window.timestamps_ns.push_back(later.camera.timestamp_ns);
  window.H_i1.push_back(H);
  window.inlier.push_back(inliers_of(inspection.initialization->plane,
                                     [&](int j) { return inspection.window->is_inlier_track(j); }));
  for (int k = 0; k < std::ssize(window.planes); ++k) {
    WindowPlane& plane = window.planes[k];
    const Plane* estimate = estimated_plane(inspection, k);
    plane.H_i1.push_back(estimate != nullptr ? homography_of(window, later.camera.pose, *estimate)
                                             : Eigen::Matrix3d::Constant(kUnseen).eval());
    plane.inlier.push_back(inliers_of(estimate != nullptr ? *estimate : Plane{}, [&](int j) {
      return estimate != nullptr && std::ranges::binary_search(plane.tracks, j);
    }));
  }
  window.points_px.push_back(later.points_px);
  window.R_wc.push_back(later.camera.pose.R_wc);
}

std::shared_ptr<const Inspection> extended(const Inspection& inspection,
                                           const std::shared_ptr<const Tracks>& tracks,
                                           const std::vector<LaterFrame>& later) {
  if (later.empty()) return nullptr;
  Inspection longer = inspection;
  Window window = *inspection.window;
  Initialization result = *inspection.initialization;
  longer.extrapolated_from = window.frame_count();
  window.noise_ratio.clear();
  window.lens_moves_px.clear();
  window.row_delay_moves_px.clear();
  for (const LaterFrame& frame : later) {
    append_frame(inspection, frame, window);
    result.cameras.push_back(frame.camera.pose);
    if (!longer.row_motions.empty()) longer.row_motions.push_back(frame.motion);
  }
  const int frames = window.frame_count();
  longer.tracks = beginning(tracks, frames);
  longer.window = std::make_shared<const Window>(std::move(window));
  longer.initialization = std::make_shared<const Initialization>(std::move(result));
  // A board's truth takes too long; without truth there is no true cube.
  longer.truth =
      inspection.recording->truth
          ? window_truth(*inspection.recording, {inspection.window->start, frames}, {}, {})
          : nullptr;
  if (!longer.truth) longer.true_cube.reset();
  return std::make_shared<const Inspection>(std::move(longer));
}

}  // namespace

std::shared_ptr<const Extrapolation> extrapolate(
    const std::shared_ptr<const Inspection>& inspection,
    int frames,
    const std::stop_token& stop,
    const Progress& progress) {
  const Window& window = *inspection->window;
  const Recording& recording = *inspection->recording;
  const int known = window.frame_count();
  const int last = std::min(recording.frame_count(), window.start + known + frames);
  Extrapolation found{inspection};
  if (!inspection->initialization->ok) throw InputError("the window is not initialized");
  const auto tracks = longer_tracks(*inspection, last - window.start, stop, progress);
  if (!tracks) return nullptr;
  const std::vector<MapPoint> points = points_of_planes(*inspection);
  Path path{inspection->initialization->cameras, window.timestamps_ns};
  std::vector<LaterFrame> later;
  for (int i = known; i < last - window.start && found.end.empty(); ++i) {
    if (stop.stop_requested()) return nullptr;
    try {
      LaterFrame frame = locate(*inspection,
                                points,
                                path,
                                recording.timestamps_ns[window.start + i],
                                undistorted(*inspection, *tracks, i));
      frame.camera.frame = window.start + i;
      path.poses.push_back(frame.camera.pose);
      path.timestamps_ns.push_back(frame.camera.timestamp_ns);
      found.cameras.push_back(frame.camera);
      later.push_back(std::move(frame));
    } catch (const InputError& error) {
      found.end = fmt::format("frame {}: {}", window.start + i, error.what());
    }
  }
  if (found.end.empty() && last == recording.frame_count()) found.end = "the recording ends";
  found.extended = extended(*inspection, tracks, later);
  return std::make_shared<const Extrapolation>(std::move(found));
}

}  // namespace gpo
