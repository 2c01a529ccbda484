// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Which tracks lie on the plane, frame by frame, and the homographies that they give.
struct PlaneTracks {
  std::vector<Eigen::Matrix3d> H_i1;      ///< p_i ~ H_i1 p_1, one a frame; NaN: lost
  std::vector<std::vector<bool>> inlier;  ///< one a frame and track
};

struct ConsistencyOptions {
  double threshold_px = 2.0;     ///< farther from its homography no track agrees [px]
  double sigmas = 3.5;           ///< nor than so many standard deviations of its frame's tracks [-]
  double least_sigma_px = 0.03;  ///< which is never taken to be less, of one coordinate [px]
  double share = 0.9;            ///< of the frames that see a track, in which it must agree [-]
  double sigmas_of_track = 3.0;  ///< by which its mean square may exceed the median track's [-]
  int least_inliers = 8;         ///< in each frame, else there is no answer
  int most_rounds = 10;          ///< of homographies and choice [-]
};

/// Starting from what RANSAC found in each frame alone: keeps the tracks that agree with the
/// homographies in nearly all frames that see them, the reference frame aside, and whose error over
/// the window does not stand out among theirs; fits the homographies to those, and repeats until
/// the choice stands still. How precise tracks are is told by the inliers of each frame, as drift
/// grows with it. A kept track is an inlier in the frames in which it agrees, any other in none.
/// `points_px` is one a frame, 2 x tracks, NaN: not seen. Nothing where too few tracks are left in
/// some frame.
std::optional<PlaneTracks> consistent_inliers(const std::vector<Eigen::Matrix2Xd>& points_px,
                                              PlaneTracks found,
                                              const ConsistencyOptions& options);

/// How a track fares in that choice.
struct TrackConsistency {
  int seen = 0;      ///< in so many frames, the reference frame aside
  int agreeing = 0;  ///< with the plane, in so many of them
  /// Of its errors, in variances of their frames; nothing where it agrees in too few frames.
  std::optional<double> mean_square;
  double largest_mean_square = 0;  ///< of those that are kept
};

/// By the homographies and the inliers that `consistent_inliers` came to; one a track.
std::vector<TrackConsistency> consistency(const std::vector<Eigen::Matrix2Xd>& points_px,
                                          const PlaneTracks& found,
                                          const ConsistencyOptions& options);

}  // namespace gpo
