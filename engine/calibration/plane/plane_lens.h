// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_adjustment.h"

#include <functional>
#include <string>

namespace gpo {

/// Result of a calibration from planes of unknown structure.
struct PlaneLens {
  bool ok = false;
  bool stopped = false;
  std::string reason;  ///< why there is no camera
  Camera camera;       ///< with standard deviations
  LensVector lens = LensVector::Zero();
  LensVector sigma = LensVector::Zero();
  std::array<bool, kLensUnknowns> prior_only{};  ///< not determined by the images
  double rms_px = 0;                             ///< [raw px]
  int points = 0;
  int views = 0;
  double tilt_deg = 0;        ///< largest angle between the plane's normals in camera axes
  double moved = 0;           ///< largest camera motion [distances from the plane]
  std::vector<int> left_out;  ///< frames that disagree with the others
};

/// Calibrates a camera by planar scenes (Triggs 1998; engine/method.md, "The lens from the plane").
/// Starts from several focal lengths, with the best normals of each, and then minimizes over lens,
/// points and poses. `guess` has the size of the images and roughly the lens distortion.
PlaneLens lens_from_planes(std::vector<ObservedPlane> planes,
                           const GyroRotations& gyro,
                           const Camera& guess,
                           const std::function<void(int done, int of)>& progress = {},
                           const std::stop_token& stop = {});

}  // namespace gpo
