// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_views.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"

#include <cstdint>
#include <vector>

namespace gpo {

/// Pictures of points on z = 0, from about 1 m.
struct SimulatedViews {
  Camera camera = {640, 480, 560, 565, 325, 232, Distortion::radial_tangential, {0.05, -0.1}};
  int points = 300;
  int images = 40;
  double half_m = 1.5;       ///< the points are within, along x and y
  double slant_deg = 35;     ///< of the plane's normal to the optical axis, at most
  double kept_tilt_deg = 0;  ///< a slant that all pictures share
  double moves_m = 0.5;      ///< sideways, at most
  double noise_px = 0.3;
  double track_noise_px = 0;  ///< the same in all pictures of a point
  double unevenness_m = 0;    ///< heights of the plane's waves, at most
  double readout = 0;         ///< of the time from frame to frame, see LensPrior
  double outliers = 0;        ///< share of the observations, up to 20 px off
};

struct SimulatedScene {
  ObservedPlane plane;
  std::vector<Pose> poses;  ///< of the sights' cameras
};

SimulatedScene simulate_views(const SimulatedViews& options, std::uint64_t seed);

}  // namespace gpo
