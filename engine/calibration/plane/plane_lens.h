// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_adjustment.h"
#include "engine/calibration/plane/plane_views.h"
#include "engine/geometry/camera.h"

#include <array>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

namespace gpo {

struct PlaneLensOptions {
  LensPrior prior = {};
  double most_focal_sigma = 0.03;  ///< above it there is no camera [-]
  double prior_only = 0.7;  ///< of a prior's sigma; what stays above is known by it alone [-]
};

/// A camera from planes of unknown structure, or the reason why there is none.
struct PlaneLens {
  bool ok = false;
  bool stopped = false;
  std::string reason;  ///< why not
  Camera camera;       ///< with its standard deviations
  LensVector lens = LensVector::Zero();
  LensVector sigma = LensVector::Zero();
  std::array<bool, kLensUnknowns> prior_only{};  ///< the pictures say nothing of it
  double rms_px = 0;                             ///< [raw px]
  int points = 0;
  int views = 0;
  double tilt_deg = 0;        ///< how far apart the plane's normals are, in the camera's axes
  double moved = 0;           ///< how far the camera moved [distances of the plane]
  std::vector<int> left_out;  ///< frames whose pictures disagree with all others
  std::vector<std::string> warnings;
};

/// Autocalibration from planar scenes (Triggs 1998; engine/method.md, "The lens from the plane"):
/// from several focal lengths, the guess' among them, each with the normals that suit it best, then
/// one least squares over the lens, all points and all poses. `guess` has the pictures' size and,
/// roughly, the lens' bend.
PlaneLens lens_from_planes(std::vector<ObservedPlane> planes,
                           const GyroRotations& gyro,
                           const Camera& guess,
                           const PlaneLensOptions& options = {},
                           const std::function<void(int done, int of)>& progress = {},
                           const std::stop_token& stop = {});

}  // namespace gpo
