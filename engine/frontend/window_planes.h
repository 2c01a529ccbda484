// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace gpo {

struct PlaneOptions {
  double gate_px = 2.0;     ///< RMS transfer error over the frames, above it no track agrees [px]
  double least_gate = 0.6;  ///< and below so much of it every one does [-]
  double gate_to_median = 2.0;     ///< in between, in medians of the plane's own tracks [-]
  int judging_frames = 6;          ///< spread over the window, in which tracks are judged
  int least_hypotheses = 300;      ///< of four neighboring tracks, for each plane
  int most_hypotheses = 3000;      ///< where few tracks agree with the best one
  int least_tracks = 8;            ///< of the first plane
  int least_more = 18;             ///< of each further one
  double least_share_more = 0.06;  ///< of all tracks, of each further one [-]
  int most_planes = 5;
  std::uint64_t seed = 1;  ///< of the hypotheses
};

struct TrackPlanes {
  std::vector<std::vector<int>> planes;
  std::vector<double> stability;  ///< of each: share of its tracks that stay at half its gate [-]
  int largest_refused = 0;        ///< tracks of the set that ended the search; 0: there was none
};

/// The planes of a window: sets of tracks each of which keeps to one homography a frame, over the
/// whole window rather than frame by frame (engine/method.md, "Planes of a window"). Columns of
/// the tracks, ascending; the plane with most tracks first; no track is in two. A set counts as a
/// plane only where its tracks stand out: those that miss its gate by little are few. `points_px`
/// is one a frame, 2 x tracks, NaN: not seen.
TrackPlanes window_planes(const std::vector<Eigen::Matrix2Xd>& points_px,
                          const PlaneOptions& options = {});

/// The frame of those given into which tracks have moved most, in the median, of those that at
/// least half of all tracks are seen in; 0 where eight are seen in none.
int widest_frame(const std::vector<Eigen::Matrix2Xd>& points_px, const std::vector<int>& frames);

}  // namespace gpo
