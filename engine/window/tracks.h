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

/// One observation of a track that somebody else's front end made.
struct TrackObservation {
  int frame;  ///< counts in the recording
  std::int64_t track;
  Eigen::Vector2d raw_px;
};

/// Why the built-in front end gave a track up.
enum class LossReason {
  left_image,
  no_flow,           ///< KLT gives up, there or on the way back
  forward_backward,  ///< the way there and back ends too far from where it began [px]
  look_not_found,    ///< too little of its look in the reference frame is in the picture
  far_from_prediction,          ///< its look is found too far from where it was expected [px]
  low_correlation        ///< what is found is not like its look: correlation too low [-]
};

/// How a track ended: what was measured and the limit that it broke, NaN where it is no number.
struct TrackEnd {
  int frame = 0;  ///< of the window, the first in which it is not seen
  LossReason reason = LossReason::no_flow;
  double value = std::numeric_limits<double>::quiet_NaN();
  double limit = std::numeric_limits<double>::quiet_NaN();
};

/// Tracks that start in the reference frame, as they were followed through the window: what the
/// picture shows. Column j of every matrix is track j; NaN where it is not seen.
struct Tracks {
  int start = 0;                         ///< reference frame, counts in the recording
  std::vector<std::int64_t> ids;         ///< one a track
  std::vector<Eigen::Matrix2Xd> raw_px;  ///< one a frame, 2 x tracks, raw pixels
  /// How far each track's way from the frame before and back ends from where it began, one a frame,
  /// of each track; NaN: not measured. Empty of other people's tracks.
  std::vector<Eigen::VectorXd> forward_backward_px = {};
  /// One a track; nothing: followed to the last frame. Empty of other people's tracks.
  std::vector<std::optional<TrackEnd>> ends = {};

  int frame_count() const { return static_cast<int>(raw_px.size()); }
  int track_count() const { return static_cast<int>(ids.size()); }
  bool seen(int frame, int track) const { return raw_px[frame].col(track).allFinite(); }
};

/// Other people's tracks that are seen in frame `start`, over `frames` frames; NaN where not seen.
Tracks select_tracks(std::span<const TrackObservation> observations, int start, int frames);

/// As if the tracks with these ids had never been seen: NaN in every frame. Columns stay.
Tracks without(Tracks tracks, std::span<const std::int64_t> ids);

}  // namespace gpo
