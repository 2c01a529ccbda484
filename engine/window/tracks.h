// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// One observation of a track from an external front end.
struct TrackObservation {
  int frame;  ///< index in the recording
  std::int64_t track;
  Eigen::Vector2d raw_px;
  double sigma_px = 0;  ///< standard deviation of each coordinate; 0: unknown
};

/// Why the built-in front end dropped a track.
enum class LossReason {
  left_image,
  no_flow,              ///< KLT failed, forward or backward
  forward_backward,     ///< the forward-backward error is too large [px]
  template_not_found,   ///< too little of the patch template is inside the image
  far_from_prediction,  ///< the alignment result is too far from the prediction [px]
  low_correlation       ///< the correlation with the template is too low [-]
};

/// How a track ended: the measured value and the limit it violated; NaN if the reason has none.
struct TrackEnd {
  int frame = 0;  ///< in the window, the first without an observation
  LossReason reason = LossReason::no_flow;
  double value = std::numeric_limits<double>::quiet_NaN();
  double limit = std::numeric_limits<double>::quiet_NaN();
};

/// Texture around the tracks that repeats within the motion that tracking allows, such as tiles:
/// each motion of a frame then has others, periods away, that fit about as well (engine/method.md,
/// "Repeated texture").
struct Repetition {
  /// From each track in the reference frame to the nearest place that looks alike, 2 x tracks [px].
  Eigen::Matrix2Xd period_px;
  /// One per frame: how much better the tracks fit the motion since the frame before than the best
  /// other one, in standard deviations; infinite in the first frame and if there is no other one.
  std::vector<double> margins = {};
};

/// Least margin of a motion that the images distinguish from others. In windows that were tracked
/// right, over tiles, bricks, dots and chessboards of 17 to 75 px, the median is at least 5; in
/// those that were wrong by periods, over exact lattices, at most 0.9 but for single frames.
inline constexpr double kDistinctMotion = 4;

/// Returns the frames whose motion the images do not distinguish from another one, nor that of the
/// frame before or after.
std::vector<int> ambiguous_frames(const Repetition& repetition);

/// Tracks that start in the reference frame, in raw pixels. Column j of every matrix is track j;
/// NaN if not observed.
struct Tracks {
  int start = 0;                         ///< reference frame, index in the recording
  std::vector<std::int64_t> ids;         ///< one per track
  std::vector<Eigen::Matrix2Xd> raw_px;  ///< one per frame, 2 x tracks
  /// Standard deviation of each observation, one vector per frame; empty: unknown, hence equal.
  std::vector<Eigen::VectorXd> sigma_px = {};
  /// Forward-backward error of each track from the previous frame, one vector per frame; NaN if not
  /// measured. Empty for external tracks.
  std::vector<Eigen::VectorXd> forward_backward_px = {};
  /// One per track; nullopt if followed to the last frame. Empty for external tracks.
  std::vector<std::optional<TrackEnd>> ends = {};
  bool anchored = false;  ///< aligned with their templates in the reference frame
  /// In anchored tracking; nullopt if the texture does not repeat.
  std::optional<Repetition> repetition = {};

  int frame_count() const { return static_cast<int>(raw_px.size()); }
  int track_count() const { return static_cast<int>(ids.size()); }
  bool seen(int frame, int track) const { return raw_px[frame].col(track).allFinite(); }
};

/// Returns the external tracks observed in frame `start`, over `frames` frames. Standard deviations
/// count if all observations have one.
Tracks select_tracks(std::span<const TrackObservation> observations, int start, int frames);

/// Marks the tracks with these ids as not observed in any frame. Their columns stay.
Tracks without(Tracks tracks, std::span<const std::int64_t> ids);

}  // namespace gpo
