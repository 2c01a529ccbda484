// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <vector>

namespace gpo {

/// How a frame of the window moved, before anything is initialized.
struct FrameMotion {
  /// Median way of the inliers since the reference frame beyond what the given rotation explains,
  /// undistorted; NaN without inliers [px].
  double parallax_px = 0;
  /// Between this frame and the next (the last one: and the one before), by the given rotations.
  double rotation_rate_deg_s = 0;
};

/// One a frame of the window.
std::vector<FrameMotion> frame_motion(const Window& window);

}  // namespace gpo
