// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

namespace gpo {

struct RansacOptions {
  bool enabled = true;  ///< off: every pair is an inlier (the paper's ablation)
  /// Largest transfer error of an inlier, in the second image [px]; nullopt: `usual_threshold_px`.
  std::optional<double> threshold_px = std::nullopt;
  std::uint64_t seed = 1;      ///< for the random samples
  double confidence = 0.9999;  ///< probability of drawing a sample without an outlier [-]
  int most_iterations = 2000;  ///< [-]

  bool operator==(const RansacOptions&) const = default;
};

/// Largest transfer error of an inlier without noise [pixel_unit].
inline constexpr double kUsualThreshold = 2;

/// Noise of one coordinate [px]: third differences over time of vectors between neighboring tracks.
/// `points_px` is one a frame, NaN: not seen. Returns 0 for fewer than four frames or eight tracks.
double track_noise_px(const std::vector<Eigen::Matrix2Xd>& points_px);

/// 2 `pixel_unit`, or 4.2 standard deviations of the noise if that is more, up to 8 `pixel_unit`.
double usual_threshold_px(const Camera& camera, const std::vector<Eigen::Matrix2Xd>& points_px);

struct RobustHomography {
  Eigen::Matrix3d H;         ///< to ~ H from, refined on its inliers
  std::vector<bool> inlier;  ///< one a pair
};

/// 4-point RANSAC (Fischler & Bolles), refined on its inliers; nullopt if fewer than 4 agree.
std::optional<RobustHomography> homography_ransac(const Eigen::Matrix2Xd& from,
                                                  const Eigen::Matrix2Xd& to,
                                                  const RansacOptions& options);

struct TrackConsistency {
  int seen = 0;      ///< frames that see it, the reference frame aside
  int agreeing = 0;  ///< frames in which it agrees with the plane
  /// Mean of its squared errors, in variances of their frames; nullopt if it agrees in too few.
  std::optional<double> mean_square;
  double largest_mean_square = 0;  ///< limit for a selected track
};

inline constexpr double kConsistentShare = 0.9;

std::vector<TrackConsistency> consistency(const Window& window);

struct TrackPlanes {
  std::vector<std::vector<int>> planes;  ///< columns of their tracks, ascending
  std::vector<double> stability;  ///< share of each one's tracks that stay at half its gate [-]
  int largest_refused = 0;        ///< tracks of the set that ended the search; 0: none
};

/// Disjoint sets of tracks, most tracks first, that follow one homography a frame over the window.
/// `points_px` is one a frame, 2 x tracks; `gate_px` the largest RMS error of a track.
TrackPlanes window_planes(const std::vector<Eigen::Matrix2Xd>& points_px,
                          double gate_px = 2,
                          std::uint64_t seed = 1);

struct InlierOptions {
  RansacOptions ransac = {};
  Inliers inliers = Inliers::per_frame;
  int leader = 0;  ///< the leading plane, counted from 0 by support (`Inliers::planes`)
};

/// Undistorts the tracks and selects inliers. Rotations are left at the identity.
Window make_window(const Tracks& tracks,
                   const Camera& camera,
                   std::span<const std::int64_t> recording_timestamps_ns,
                   const InlierOptions& options);

}  // namespace gpo
