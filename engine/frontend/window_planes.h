// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace gpo {

struct PlaneOptions {
  double gate_px = 2.0;            ///< largest RMS transfer error of an agreeing track [px]
  double least_gate = 0.6;         ///< share of it below which every track agrees [-]
  double gate_to_median = 2.0;     ///< gate in between, in medians of the plane's own tracks [-]
  int judging_frames = 6;          ///< in which tracks are judged, spread over the window
  int least_hypotheses = 300;      ///< from four neighboring tracks, for each plane
  int most_hypotheses = 3000;      ///< if few tracks agree with the best one
  int least_tracks = 8;            ///< on the first plane
  int least_more = 18;             ///< on each further one
  double least_share_more = 0.06;  ///< share of all tracks of each further one [-]
  int most_planes = 5;
  std::uint64_t seed = 1;  ///< for the hypotheses
};

struct TrackPlanes {
  std::vector<std::vector<int>> planes;  ///< columns of their tracks, ascending
  std::vector<double> stability;  ///< share of each one's tracks that stay at half its gate [-]
  int largest_refused = 0;        ///< tracks of the set that ended the search; 0: none
};

/// Extracts the planes of a window: sets of tracks that follow one homography a frame, over the
/// whole window rather than frame by frame (engine/method.md, "Planes of a window"). The plane with
/// most tracks comes first; no track is in two. A set is accepted only if few tracks miss its gate
/// by little. `points_px` is one a frame, 2 x tracks, NaN: not seen.
TrackPlanes window_planes(const std::vector<Eigen::Matrix2Xd>& points_px,
                          const PlaneOptions& options = {});

/// Returns the given frame with the largest median motion of tracks, of those that see at least
/// half of all tracks; 0 if no frame sees eight.
int widest_frame(const std::vector<Eigen::Matrix2Xd>& points_px, const std::vector<int>& frames);

}  // namespace gpo
