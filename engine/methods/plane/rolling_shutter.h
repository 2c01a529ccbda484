// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

namespace gpo {

/// Corrects the inliers of a window for rolling shutter (engine/method.md, eq. 11): moves them to
/// where they would be if every row had been read at its frame's time stamp, which is that of the
/// principal point's row. `row_delay_s` is the time between two rows of the undistorted image [s];
/// poses between the frames of `motion` are interpolated (quadratic around each frame).
Window without_rolling_shutter(const Window& window, const PlaneMotion& motion, double row_delay_s);

}  // namespace gpo
