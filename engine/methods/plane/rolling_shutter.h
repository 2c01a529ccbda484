// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

namespace gpo {

/// The window as a global shutter would have seen it (engine/method.md, eq. 11): inliers moved to
/// where they would be, had every row been read at its frame's time stamp, which is that of the
/// principal point's row. `row_delay_s` passes from one row to the next [s]; poses between the
/// frames of `motion` are interpolated (quadratic around each frame). Rows are those of the
/// undistorted picture.
Window without_rolling_shutter(const Window& window, const PlaneMotion& motion, double row_delay_s);

}  // namespace gpo
