// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"

#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// How sure a pose is that was computed from a picture of a board: standard deviations, roots of
/// the covariances' traces, from the noise that the fit's residuals show. Of an error in the
/// calibration, in the board's size or its flatness they know nothing.
struct PoseUncertainty {
  double rms_px = 0;              ///< distance of the board's corners from where the pose puts them
  double position_sigma_m = 0;    ///< of the camera in the board's frame
  double rotation_sigma_deg = 0;  ///< of the camera
  double normal_sigma_deg = 0;    ///< of the board's normal in the camera's frame
};

/// True camera poses, one entry a frame; nothing where a frame has none.
struct GroundTruth {
  std::string source;                                           ///< file name, for people
  std::vector<std::optional<Pose>> poses;                       ///< in the truth's world [m]
  std::vector<std::optional<PoseUncertainty>> uncertainties{};  ///< as `poses`; empty: not known
  bool upright = false;  ///< the world's z axis points away from gravity
};

/// The truth over one window, in the truth's own world.
struct WindowTruth {
  std::string source;
  std::vector<std::optional<Pose>> cameras;                     ///< one a frame of the window [m]
  std::optional<Plane> plane;                                   ///< [m]
  std::vector<std::optional<PoseUncertainty>> uncertainties{};  ///< as `cameras`; empty: not known
  bool upright = false;  ///< the world's z axis points away from gravity
};

}  // namespace gpo
