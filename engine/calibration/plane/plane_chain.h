// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_lens.h"
#include "engine/frontend/tracking/tracker.h"
#include "engine/geometry/camera.h"

#include <map>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The first image of a window, with the tracks on its plane.
struct PlaneReference {
  int frame = 0;            ///< index in the recording
  Eigen::Matrix2Xd raw_px;  ///< 2 x points
};

/// A part of the recording through which one plane was followed.
struct PlaneChain {
  std::vector<PlaneReference> references;  ///< one a window, in the order of time
  /// Homography from the undistorted pixels of the first frame to those of each frame.
  std::map<int, Eigen::Matrix3d> H_i_first;
};

/// Every `step`-th image of a recording.
struct ChainImages {
  GrayImages gray;  ///< by frame of the recording
  int frames = 0;   ///< number of frames in the recording
  int step = 1;
  FrameProgress progress;
  std::stop_token stop;
};

/// Follows the plane with most tracks from window to window. Each window begins where the one
/// before ended and continues with the plane there; a lost plane ends the chain. `camera` is a
/// guess. Incomplete if stopped.
std::vector<PlaneChain> plane_chains(const ChainImages& images, const Camera& camera);

/// Returns the guess with the k1 for which most tracks of a few windows are on one plane: strong
/// distortion tears planes apart.
Camera with_likely_distortion(const ChainImages& images, const Camera& guess);

/// Finds the points of a chain's references in at most `most_views` images of the chain by their
/// patches, warped by the homography from their reference: one set of points seen from everywhere.
ObservedPlane linked_views(const ChainImages& images,
                           const PlaneChain& chain,
                           const Camera& camera,
                           int most_views);

}  // namespace gpo
