// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

namespace gpo {

struct MadeOptions {
  bool distorted = true;        ///< radial-tangential lens distortion
  bool images = true;           ///< images of a checkered floor
  bool ok = true;               ///< false: it failed, with a reason
  bool refused = false;         ///< the checks reject its result
  bool truth = true;            ///< true cameras and plane
  double estimate_error = 0;    ///< tilt of the estimated world [deg]
  double normal_sigma_deg = 0;  ///< above 0: with uncertainty and verdicts of a growing window
};

/// Returns a synthetic inspection of a camera that moves over a floor, seen obliquely: 30 frames of
/// a recording of 40, 150 tracks, a tenth of them outliers. Uses closed forms, not the engine.
Inspection made_inspection(const MadeOptions& options = {});

}  // namespace gpo
