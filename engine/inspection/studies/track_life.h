// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

namespace gpo {

/// Returns H_i1 = K R_ciw (I - tau_i n^T) K^-1 by the result's plane and poses, undistorted;
/// nullopt if the initialization failed.
std::optional<Eigen::Matrix3d> estimated_homography(const Inspection& inspection,
                                                    int frame_in_window);

/// Returns the lengths of the inliers' residuals in a frame of the window [raw px]: from the
/// observation to the result's prediction from the reference frame. Empty if the initialization
/// failed.
std::vector<double> residuals_px(const Inspection& inspection, int frame_in_window);

struct TrackFrame {
  int frame = 0;           ///< in the recording
  Eigen::Vector2d raw_px;  ///< observation
  /// Transfer error by the frame's homography, undistorted, which RANSAC compares with its
  /// threshold; nullopt in the reference frame.
  std::optional<double> transfer_px = {};
  /// Residual against the result's plane and poses [raw px]; nullopt without a prediction.
  std::optional<double> residual_px = {};
  std::optional<double> forward_backward_px = {};  ///< nullopt if not measured
  bool inlier = false;
};

/// History of a track of a window.
struct TrackLife {
  std::int64_t id = 0;
  int column = 0;                                 ///< column of the window's matrices
  std::vector<TrackFrame> frames;                 ///< frames that see it
  std::optional<double> depth;                    ///< map point's depth in the reference camera [d]
  std::optional<int> inlier_since, inlier_until;  ///< in the recording, the reference frame aside
  std::string verdict;                            ///< one sentence for people
};

/// Returns the history of a column of the window; for an excluded track as it was observed.
TrackLife track_life(const Inspection& inspection, int column);

/// Returns the RMS of the residuals in the frames where the track is an inlier of the leading
/// plane; nullopt without any.
std::optional<double> rms_residual_px(const TrackLife& life);

/// Returns every track of a window in every frame that sees it, as a table that `read_tracks` can
/// read: `frame,track,x,y` in raw pixels, the number of its plane (empty: none), inlier or outlier,
/// the residual [raw px] (empty: none) and why it is an outlier or lost.
std::string tracks_csv(const Inspection& inspection);

}  // namespace gpo
