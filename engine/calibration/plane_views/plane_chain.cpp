// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane_views/plane_chain.h"

#include "engine/frontend/make_window.h"
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

// Of a lens that sees 70 degrees along the picture's diagonal.
constexpr std::array kBends{0.0, -0.7, -0.5, -0.35, -0.2, -0.1, 0.1};
constexpr int kBendWindows = 3;
constexpr double kClearlyMore = 1.1;  // tracks than without a bend

/// A window of every step-th picture; frames count in steps.
std::optional<Window> window_at(const ChainImages& images,
                                const Camera& camera,
                                int start,
                                int frames,
                                const ChainOptions& options,
                                Tracks* tracks_out) {
  const auto gray = [&](int k) { return images.gray(k * images.step); };
  const auto tracks = track_window(gray, camera, {start, frames}, options.tracker, {images.stop});
  if (!tracks || tracks->track_count() == 0) return std::nullopt;
  const std::vector<std::int64_t> times(start + frames, 0);
  Window window =
      make_window(*tracks,
                  camera,
                  times,
                  {.ransac = {.threshold_px = options.gate_px}, .inliers = Inliers::planes});
  if (tracks_out != nullptr) *tracks_out = *tracks;
  return window;
}

std::vector<cv::Point2f> places(const Window& window, const std::vector<int>& tracks, int frame) {
  std::vector<cv::Point2f> points;
  for (const int j : tracks) {
    const auto p = window.points_px[frame].col(j);
    if (p.allFinite()) points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  return points;
}

/// The plane most of whose tracks are within a hull; the first where there is no hull.
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

/// The last frame to which the plane's homography is known by enough tracks.
int last_known(const WindowPlane& plane, int least) {
  int last = 0;
  for (std::size_t i = 1; i < plane.H_i1.size(); ++i) {
    if (!plane.H_i1[i].allFinite() || std::ranges::count(plane.inlier[i], true) < least) break;
    last = static_cast<int>(i);
  }
  return last;
}

int most_on_a_plane(const ChainImages& images,
                    const std::vector<Tracks>& windows,
                    const Camera& camera,
                    const ChainOptions& options) {
  int sum = 0;
  for (const Tracks& tracks : windows) {
    const std::vector<std::int64_t> times(tracks.start + tracks.frame_count(), 0);
    const Window window =
        make_window(tracks,
                    camera,
                    times,
                    {.ransac = {.threshold_px = options.gate_px}, .inliers = Inliers::planes});
    if (!window.planes.empty()) sum += static_cast<int>(window.planes[0].tracks.size());
    if (images.stop.stop_requested()) break;
  }
  return sum;
}

}  // namespace

Camera with_likely_bend(const ChainImages& images,
                        const Camera& guess,
                        const ChainOptions& options) {
  const int count = (images.frames + images.step - 1) / images.step;
  const int frames = std::min(options.window_frames, count);
  std::vector<Tracks> windows;
  for (int k = 0; k < kBendWindows; ++k) {
    const int start = k * std::max(0, count - frames) / (kBendWindows - 1);
    Tracks tracks;
    if (window_at(images, guess, start, frames, options, &tracks))
      windows.push_back(std::move(tracks));
  }
  Camera best = guess;
  best.distortion = Distortion::radial_tangential;
  double most = 0;
  for (const double bend : kBends) {
    Camera camera = best;
    camera.coefficients = {bend, 0, 0, 0};
    const double tracks = most_on_a_plane(images, windows, camera, options);
    const double enough = bend == 0 ? 1 : kClearlyMore;
    if (tracks / enough <= most) continue;
    most = tracks / enough;
    best.coefficients = camera.coefficients;
  }
  if (best.coefficients.empty()) best.coefficients = {0, 0, 0, 0};
  return best;
}

std::vector<PlaneChain> plane_chains(const ChainImages& images,
                                     const Camera& camera,
                                     const ChainOptions& options) {
  const int count = (images.frames + images.step - 1) / images.step;
  std::vector<PlaneChain> chains;
  std::vector<cv::Point2f> hull;  // of the plane's tracks, where the last window ended
  int start = 0;
  while (start + 1 < count && !images.stop.stop_requested()) {
    if (images.progress) images.progress(start, count);
    const int frames = std::min(options.window_frames + 1, count - start);
    Tracks tracks;
    const auto window = window_at(images, camera, start, frames, options, &tracks);
    int last = 0;
    if (window && !window->planes.empty()) {
      const WindowPlane& plane = window->planes[plane_within(*window, hull)];
      last = last_known(plane, options.least_tracks);
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
            {start * images.step, tracks.raw_px[0](Eigen::all, plane.tracks)});
        hull.clear();
        cv::convexHull(places(*window, plane.tracks, last), hull);
      }
    }
    if (last == 0) hull.clear();
    start += std::max(1, last);
  }
  return chains;
}

}  // namespace gpo
