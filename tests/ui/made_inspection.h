// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

namespace gpo {

/// What a made-up inspection is like.
struct MadeOptions {
  bool distorted = true;        ///< through a lens with radial-tangential distortion
  bool images = true;         ///< a drawn checkered floor
  bool ok = true;               ///< else it failed, with a reason
  bool refused = false;         ///< what it found was not believed
  bool truth = true;            ///< known true cameras and plane
  double estimate_error = 0;    ///< tilt of the estimated world [deg]
  double normal_sigma_deg = 0;  ///< above 0: with uncertainty and verdicts, of a window that grows
};

/// A camera that moves over a floor, seen aslant: 30 frames, of 40 in the recording; 150 tracks, a
/// tenth of them outliers. Made from closed forms, without the engine's algorithms.
Inspection made_inspection(const MadeOptions& options = {});

}  // namespace gpo
