// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_lens.h"
#include "engine/geometry/pose.h"

#include <cstdint>
#include <vector>

namespace gpo {

/// Images of points on z = 0 from about 1 m.
struct SimulatedViews {
  Camera camera = {640, 480, 560, 565, 325, 232, Distortion::radial_tangential, {0.05, -0.1}};
  int points = 150;
  int images = 30;
  double half_m = 1.5;        ///< half the side of the square with the points
  double slant_deg = 35;      ///< largest angle of the plane's normal to the optical axis
  double kept_tilt_deg = 0;   ///< slant that all images share
  double moves_m = 0.5;       ///< largest motion sideways
  double noise_px = 0.3;      ///< for each observation
  double track_noise_px = 0;  ///< the same in all images of a point
  double unevenness_m = 0;    ///< largest height of the plane's waves
  double readout = 0;         ///< see LensPrior [frame intervals]
  double outliers = 0;        ///< share of observations that are up to 20 px off
};

struct SimulatedScene {
  ObservedPlane plane;
  std::vector<Pose> poses;  ///< camera of each view
};

SimulatedScene simulate_views(const SimulatedViews& options, std::uint64_t seed);

}  // namespace gpo
