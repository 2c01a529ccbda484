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

/// Estimates the noise of one coordinate from the tracks alone, on any surface [px]: from third
/// differences over time of the vectors between neighboring tracks, which hardly change if the
/// camera moves smoothly. Drift and errors of the lens do not count. `points_px` is one per frame,
/// 2 x tracks, NaN: not seen. Returns 0 if there are fewer than four frames or eight tracks.
double track_noise_px(const std::vector<Eigen::Matrix2Xd>& points_px);

/// Returns the tracks that do not move in the image although the homographies of the moving tracks
/// predict it, ascending: an overlay, a part of the camera's carrier, dirt on the lens, or a camera
/// at rest before a moving object. A track near the focus of expansion is not among them. Empty if
/// all tracks rest. `points_px` is one per frame, 2 x tracks, undistorted, NaN: not seen;
/// `sigma_px` as `Tracks::sigma_px`; `unit_px` is the `pixel_unit`.
std::vector<int> static_tracks(const std::vector<Eigen::Matrix2Xd>& points_px,
                               const std::vector<Eigen::VectorXd>& sigma_px,
                               double unit_px);

/// Returns the default of `RansacOptions::threshold_px`: 2 `pixel_unit`, or 4.2 standard deviations
/// of the tracks' noise if that is more, up to 8 `pixel_unit`.
double usual_threshold_px(const Camera& camera, const std::vector<Eigen::Matrix2Xd>& points_px);

struct RobustHomography {
  Eigen::Matrix3d H;         ///< to ~ H from, refined on its inliers
  std::vector<bool> inlier;  ///< one a pair
};

/// Estimates a homography by 4-point RANSAC (Fischler & Bolles), checking each sample's
/// orientation, and refines it on its inliers. `from` and `to` are 2 x n. Returns nullopt if fewer
/// than 4 pairs agree. The threshold of each pair is multiplied by its `noise_ratio`; empty: ones.
std::optional<RobustHomography> homography_ransac(const Eigen::Matrix2Xd& from,
                                                  const Eigen::Matrix2Xd& to,
                                                  const RansacOptions& options,
                                                  const Eigen::VectorXd& noise_ratio = {});

/// Criteria by which `Inliers::consistent` selects a track.
struct TrackConsistency {
  int seen = 0;      ///< frames that see it, the reference frame aside
  int agreeing = 0;  ///< frames in which it agrees with the plane
  /// Mean of its squared errors, in variances of their frames; nullopt if it agrees in too few.
  std::optional<double> mean_square;
  double largest_mean_square = 0;  ///< limit for a selected track
};

/// Share of the frames that see a consistent track, in which it must agree.
inline constexpr double kConsistentShare = 0.9;

/// Evaluates the criteria of a window of consistent inliers, one per track.
std::vector<TrackConsistency> consistency(const Window& window);

/// Returns the largest transfer error of an inlier in each frame, to be multiplied by
/// `Window::gate_factor` [px]: the window's threshold, for consistent inliers also at most 3.5
/// standard deviations of the frame's tracks.
std::vector<double> frame_gates_px(const Window& window);

struct TrackPlanes {
  std::vector<std::vector<int>> planes;  ///< columns of their tracks, ascending
  std::vector<double> stability;  ///< share of each one's tracks that stay at half its gate [-]
  int largest_refused = 0;        ///< tracks of the set that ended the search; 0: none
};

/// Extracts the planes of a window: sets of tracks that follow one homography a frame, over the
/// whole window rather than frame by frame (engine/method.md, "Planes of a window"). The plane with
/// most tracks comes first; no track is in two. A set is accepted only if few tracks miss its gate
/// by little. `points_px` is one per frame, 2 x tracks, NaN: not seen. `gate_px` is the largest RMS
/// transfer error of an agreeing track with the `noise_ratio` 1 (`Window::noise_ratio`).
/// `on_first_plane` as `InlierOptions::on_first_plane`.
TrackPlanes window_planes(const std::vector<Eigen::Matrix2Xd>& points_px,
                          double gate_px = 2,
                          std::uint64_t seed = 1,
                          const std::vector<Eigen::VectorXd>& noise_ratio = {},
                          const std::vector<bool>& on_first_plane = {});

/// The errors by which the tracks of a window were put on one of its planes (`window_planes`).
struct PlaneErrors {
  /// RMS transfer error of each track over a few frames of the window, over its
  /// `Window::gate_factor` [px]; infinite: none of these frames sees it.
  Eigen::VectorXd rms_px;
  double gate_px = 0;  ///< largest `rms_px` of a track on the plane
};

/// Computes the errors of a window's planes again, one for each of `Window::planes`.
std::vector<PlaneErrors> plane_errors(const Window& window);

struct InlierOptions {
  RansacOptions ransac = {};
  Inliers inliers = Inliers::per_frame;
  int leader = 0;  ///< the leading plane, counted from 0 by support (`Inliers::planes`)
  /// One per track: may be on the first plane of the window, and on no other one; this plane comes
  /// first whatever its support. Empty: unknown, each may be on any plane.
  std::vector<bool> on_first_plane = {};
};

/// Undistorts the tracks, leaves out static ones (`static_tracks`) and selects inliers: between the
/// reference frame and each other frame, and for `Inliers::consistent` also over the window if
/// enough tracks are consistent, or by extracting the window's planes. With `on_first_plane`, the
/// first plane is found among these tracks and all further ones among the others; without planes
/// only these tracks may be inliers. Rotations are left at the identity. `recording_timestamps_ns`
/// has all frames of the recording.
Window make_window(const Tracks& tracks,
                   const Camera& camera,
                   std::span<const std::int64_t> recording_timestamps_ns,
                   const InlierOptions& options);

}  // namespace gpo
