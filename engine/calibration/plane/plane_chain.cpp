// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_chain.h"

#include "engine/frontend/inliers.h"
#include "engine/geometry/homography.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

// k1 of a lens with a diagonal field of view of 70 deg.
constexpr std::array kDistortions{0.0, -0.7, -0.5, -0.35, -0.2, -0.1, 0.1};
constexpr int kDistortionWindows = 3;
constexpr double kClearlyMore = 1.1;  // tracks than without distortion
constexpr int kWindowFrames = 20;     // until corners are detected again
constexpr int kLeastTracks = 20;      // on the plane
constexpr double kChainGate_px = 3;   // see PlaneOptions; wide, as the lens is a guess

Window window_of(const Tracks& tracks, const Camera& camera) {
  const std::vector<std::int64_t> times(tracks.start + tracks.frame_count(), 0);
  return make_window(tracks,
                     camera,
                     times,
                     {.ransac = {.threshold_px = kChainGate_px}, .inliers = Inliers::planes});
}

/// Tracks in every step-th image; start and frames count in steps. nullopt if there are none.
std::optional<Tracks> tracks_at(const ChainImages& images,
                                const Camera& camera,
                                int start,
                                int frames) {
  const auto gray = [&](int k) { return images.gray(k * images.step); };
  const TrackerOptions options{.tracking = Tracking::anchored};
  auto tracks = track_window(gray, camera, {start, frames}, options, {images.stop});
  if (tracks && tracks->track_count() == 0) tracks.reset();
  return tracks;
}

std::vector<cv::Point2f> places(const Window& window, const std::vector<int>& tracks, int frame) {
  std::vector<cv::Point2f> points;
  for (const int j : tracks) {
    const auto p = window.points_px[frame].col(j);
    if (p.allFinite()) points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  return points;
}

/// The plane with most tracks within a hull; the first plane without a hull.
int plane_within(const Window& window, const std::vector<cv::Point2f>& hull) {
  if (hull.size() < 3) return 0;
  int best = 0;
  std::ptrdiff_t most = -1;
  for (std::size_t k = 0; k < window.planes.size(); ++k) {
    const auto points = places(window, window.planes[k].tracks, 0);
    const auto inside = std::ranges::count_if(
        points, [&](const cv::Point2f& p) { return cv::pointPolygonTest(hull, p, false) >= 0; });
    if (inside <= most) continue;
    most = inside;
    best = static_cast<int>(k);
  }
  return best;
}

/// The last frame whose homography enough tracks determine.
int last_known(const WindowPlane& plane) {
  int last = 0;
  for (std::size_t i = 1; i < plane.H_i1.size(); ++i) {
    if (!plane.H_i1[i].allFinite() || std::ranges::count(plane.inlier[i], true) < kLeastTracks)
      break;
    last = static_cast<int>(i);
  }
  return last;
}

}  // namespace

Camera with_likely_distortion(const ChainImages& images, const Camera& guess) {
  const int count = (images.frames + images.step - 1) / images.step;
  const int frames = std::min(kWindowFrames, count);
  std::vector<Tracks> windows;
  for (int k = 0; k < kDistortionWindows; ++k) {
    const int start = k * std::max(0, count - frames) / (kDistortionWindows - 1);
    if (auto tracks = tracks_at(images, guess, start, frames))
      windows.push_back(*std::move(tracks));
  }
  Camera best = guess;
  best.distortion = Distortion::radial_tangential;
  if (best.coefficients.empty()) best.coefficients = {0, 0, 0, 0};
  double most = 0;
  for (const double k1 : kDistortions) {
    Camera camera = best;
    camera.coefficients = {k1, 0, 0, 0};
    double on_plane = 0;
    for (const Tracks& tracks : windows) {
      const Window window = window_of(tracks, camera);
      if (!window.planes.empty()) on_plane += static_cast<double>(window.planes[0].tracks.size());
      if (images.stop.stop_requested()) break;
    }
    if (k1 != 0) on_plane /= kClearlyMore;
    if (on_plane <= most) continue;
    most = on_plane;
    best = camera;
  }
  return best;
}

std::vector<PlaneChain> plane_chains(const ChainImages& images, const Camera& camera) {
  const int count = (images.frames + images.step - 1) / images.step;
  std::vector<PlaneChain> chains;
  std::vector<cv::Point2f> hull;  // around the plane's tracks at the end of the last window
  int start = 0;
  while (start + 1 < count && !images.stop.stop_requested()) {
    if (images.progress) images.progress(start, count);
    const int frames = std::min(kWindowFrames + 1, count - start);
    const auto tracks = tracks_at(images, camera, start, frames);
    const Window window = tracks ? window_of(*tracks, camera) : Window{};
    int last = 0;
    if (!window.planes.empty()) {
      const WindowPlane& plane = window.planes[plane_within(window, hull)];
      last = last_known(plane);
      if (last > 0) {
        if (hull.empty()) {
          chains.emplace_back();
          chains.back().H_i_first[start * images.step].setIdentity();
        }
        PlaneChain& chain = chains.back();
        const Matrix3d to_start = chain.H_i_first.at(start * images.step);
        for (int i = 1; i <= last; ++i) {
          const Matrix3d H = plane.H_i1[i] * to_start;
          chain.H_i_first[(start + i) * images.step] = H / H.norm();
        }
        chain.references.push_back(
            {start * images.step, tracks->raw_px[0](Eigen::all, plane.tracks)});
        hull.clear();
        cv::convexHull(places(window, plane.tracks, last), hull);
      }
    }
    if (last == 0) hull.clear();
    start += std::max(1, last);
  }
  return chains;
}

}  // namespace gpo
