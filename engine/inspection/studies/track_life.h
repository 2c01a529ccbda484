// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/window/tracks.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A track in a frame that sees it.
struct TrackFrame {
  int frame = 0;           ///< in the recording
  Eigen::Vector2d raw_px;  ///< where it is seen
  /// Transfer error of the frame's own homography, undistorted, which RANSAC compares with its
  /// threshold; nothing in the reference frame.
  std::optional<double> transfer_px;
  /// From there to where the result's plane and poses put it, in raw pixels; nothing where the
  /// initialization failed or puts it nowhere.
  std::optional<double> residual_px;
  std::optional<double> forward_backward_px;  ///< where the built-in front end measured it
  bool inlier = false;
};

/// All that is known of a track of a window.
struct TrackLife {
  std::int64_t id = 0;
  int column = 0;                                 ///< of the window's matrices
  std::vector<TrackFrame> frames;                 ///< those that see it
  std::optional<double> depth;                    ///< of its map point in the reference camera [d]
  std::optional<int> inlier_since, inlier_until;  ///< in the recording, the reference frame aside
  std::string verdict;                            ///< one sentence for people
};

/// The track of a column of the window; also of one left out by hand, as it was seen.
TrackLife track_life(const Inspection& inspection, int column);

/// Root mean square of its residuals in the frames where it is an inlier of the leading plane, by
/// which they are told; nothing where there is none.
std::optional<double> rms_residual_px(const TrackLife& life);

/// "forward-backward error 0.83 px above 0.5 px".
std::string reason_of(const TrackEnd& end);

}  // namespace gpo
