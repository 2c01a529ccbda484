// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/tracker.h"
#include "engine/geometry/camera.h"

#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A window's first picture, and where tracks on its plane are in it.
struct PlaneReference {
  int frame = 0;            ///< counts in the recording
  Eigen::Matrix2Xd raw_px;  ///< 2 x points
};

/// A stretch of the recording through which one plane was followed.
struct PlaneChain {
  std::vector<PlaneReference> references;  ///< one a window, in the order of time
  /// From the undistorted pixels of the first frame to those of each one.
  std::map<int, Eigen::Matrix3d> H_i_first;
};

struct ChainOptions {
  int window_frames = 20;  ///< that are followed before corners are found anew
  int least_tracks = 20;   ///< on the plane, or it is not followed any farther
  double gate_px = 3;      ///< see PlaneOptions; wide, for the lens is a guess
  TrackerOptions tracker = {.tracking = Tracking::anchored};
};

/// Every `step`-th picture of a recording, and how it goes on.
struct ChainImages {
  GrayImages gray;  ///< by its frame in the recording
  int frames = 0;     ///< of the recording
  int step = 1;
  FrameProgress progress;
  std::stop_token stop;
};

/// Follows the plane that most tracks are on from window to window, each of which begins where the
/// one before ended and goes on with the plane that lies where that one's tracks ended. Where it is
/// lost, the next chain begins. `camera` is a guess. Fewer where stopped.
std::vector<PlaneChain> plane_chains(const ChainImages& images,
                                     const Camera& camera,
                                     const ChainOptions& options = {});

/// The guess with a k1 by which most tracks of a few windows lie on one plane: a lens that bends
/// much would tear every plane apart.
Camera with_likely_bend(const ChainImages& images,
                        const Camera& guess,
                        const ChainOptions& options = {});

}  // namespace gpo
