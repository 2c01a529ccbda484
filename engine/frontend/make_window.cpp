// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/make_window.h"

#include "engine/frontend/window_planes.h"
#include "engine/geometry/homography.h"
#include "engine/window/window.h"

#include <algorithm>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

const Eigen::Matrix3d kUnknownHomography =
    Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());

/// A track that is matched wrongly in one frame pulls that frame's homography away from all others.
/// This happens with descriptor matches, not with tracking. Below this share RANSAC replaces it.
constexpr double kLeastAgreeing = 0.5;

Eigen::Matrix2Xd undistort_all(const Camera& camera, const Eigen::Matrix2Xd& raw_px) {
  Eigen::Matrix2Xd points(2, raw_px.cols());
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) points.col(j) = undistort(camera, raw_px.col(j));
  return points;
}

std::vector<std::vector<Eigen::Matrix2Xd>> lens_moves(const Camera& camera, const Window& window) {
  const std::size_t parameters = camera.sigmas.size();
  std::vector moves(parameters, window.points_px);
  for (int i = 0; parameters > 0 && i < window.frame_count(); ++i) {
    for (Eigen::Index j = 0; j < window.track_count(); ++j) {
      const Eigen::Matrix2Xd of_point = undistortion_sigmas_px(camera, window.points_px[i].col(j));
      for (std::size_t k = 0; k < parameters; ++k) moves[k][i].col(j) = of_point.col(k);
    }
  }
  return moves;
}

void add_homography(Window& window, int frame, const RansacOptions& ransac) {
  std::vector<int> seen;
  for (int j = 0; j < window.track_count(); ++j)
    if (window.points_px[0].col(j).allFinite() && window.points_px[frame].col(j).allFinite())
      seen.push_back(j);
  const auto robust = homography_ransac(
      window.points_px[0](Eigen::all, seen), window.points_px[frame](Eigen::all, seen), ransac);
  window.inlier.emplace_back(window.track_count(), false);
  window.H_i1.push_back(robust ? robust->H : kUnknownHomography);
  for (std::size_t k = 0; robust && k < seen.size(); ++k)
    window.inlier[frame][seen[k]] = robust->inlier[k];
}

/// Leaves the window unchanged if too few tracks are consistent.
void select_consistent(Window& window, double threshold_px) {
  auto selected = consistent_inliers(window.points_px, {window.H_i1, window.inlier}, threshold_px);
  if (!selected) return;
  window.H_i1 = std::move(selected->H_i1);
  window.inlier = std::move(selected->inlier);
  window.inliers = Inliers::consistent;
}

WindowPlane plane_of(const Window& window,
                     const std::vector<int>& tracks,
                     const RansacOptions& ransac) {
  const int frames = window.frame_count();
  WindowPlane plane{tracks,
                    std::vector<Eigen::Matrix3d>(frames, kUnknownHomography),
                    std::vector(frames, std::vector<bool>(window.track_count(), false))};
  plane.H_i1[0] = Eigen::Matrix3d::Identity();
  for (const int j : tracks) plane.inlier[0][j] = true;
  for (int i = 1; i < frames; ++i) {
    std::vector<int> seen;
    for (const int j : tracks)
      if (window.points_px[i].col(j).allFinite()) seen.push_back(j);
    if (seen.size() < 4) continue;
    const Eigen::Matrix2Xd from = window.points_px[0](Eigen::all, seen);
    const Eigen::Matrix2Xd to = window.points_px[i](Eigen::all, seen);
    const auto H = fit_homography(from, to);
    if (!H) continue;
    plane.H_i1[i] = refine_homography(*H, from, to);
    std::size_t agreeing = 0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const double error_px = (transfer(plane.H_i1[i], from.col(k)) - to.col(k)).norm();
      plane.inlier[i][seen[k]] = error_px <= ransac.threshold_px;
      agreeing += plane.inlier[i][seen[k]] ? 1 : 0;
    }
    if (static_cast<double>(agreeing) >= kLeastAgreeing * static_cast<double>(seen.size()))
      continue;
    const auto robust = homography_ransac(from, to, ransac);
    if (!robust) continue;
    plane.H_i1[i] = robust->H;
    for (std::size_t k = 0; k < seen.size(); ++k) plane.inlier[i][seen[k]] = robust->inlier[k];
  }
  return plane;
}

/// Returns the share of the reference image that the convex hull of the tracks covers.
double image_share(const Window& window, const std::vector<int>& tracks, const Camera& camera) {
  if (tracks.size() < 3 || camera.width == 0) return 0;
  std::vector<cv::Point2f> points, hull;
  for (const int j : tracks)
    points.emplace_back(static_cast<float>(window.points_px[0](0, j)),
                        static_cast<float>(window.points_px[0](1, j)));
  cv::convexHull(points, hull);
  return std::min(1.0, cv::contourArea(hull) / (1.0 * camera.width * camera.height));
}

void find_planes(Window& window, const Camera& camera, const InlierOptions& options) {
  const RansacOptions& ransac = options.ransac;
  window.inliers = Inliers::planes;
  const TrackPlanes found =
      window_planes(window.points_px, {.gate_px = ransac.threshold_px, .seed = ransac.seed});
  window.largest_refused = found.largest_refused;
  for (std::size_t k = 0; k < found.planes.size(); ++k) {
    window.planes.push_back(plane_of(window, found.planes[k], ransac));
    window.planes.back().image_share = image_share(window, found.planes[k], camera);
    window.planes.back().stability = found.stability[k];
  }
  if (window.planes.empty()) window.planes.push_back(plane_of(window, {}, ransac));
  window.leader = std::clamp(options.leader, 0, static_cast<int>(window.planes.size()) - 1);
  window.H_i1 = window.planes[window.leader].H_i1;
  window.inlier = window.planes[window.leader].inlier;
  if (window.planes[0].tracks.empty()) window.planes.clear();
}

}  // namespace

Window make_window(const Tracks& tracks,
                   const Camera& camera,
                   std::span<const std::int64_t> recording_timestamps_ns,
                   const InlierOptions& options) {
  const RansacOptions& ransac = options.ransac;
  Window window;
  window.start = tracks.start;
  window.K = intrinsic_matrix(camera);
  for (int i = 0; i < tracks.frame_count(); ++i) {
    window.timestamps_ns.push_back(recording_timestamps_ns[tracks.start + i]);
    window.points_px.push_back(undistort_all(camera, tracks.raw_px[i]));
  }
  window.lens_moves_px = lens_moves(camera, window);
  if (options.inliers == Inliers::planes && ransac.enabled) {
    find_planes(window, camera, options);
  } else {
    window.H_i1.push_back(Eigen::Matrix3d::Identity());
    window.inlier.emplace_back(tracks.track_count(), false);
    for (int i = 1; i < window.frame_count(); ++i) add_homography(window, i, ransac);
  }
  if (options.inliers == Inliers::consistent && ransac.enabled)
    select_consistent(window, ransac.threshold_px);
  for (int j = 0; j < window.track_count(); ++j) window.inlier[0][j] = window.is_inlier_track(j);
  window.R_wc.assign(window.frame_count(), Eigen::Matrix3d::Identity());
  window.errors = frame_errors(window);
  return window;
}

}  // namespace gpo
