// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

namespace gpo {

/// Corrects the inliers of a window for rolling shutter (engine/method.md, eq. 11): moves them to
/// where they would be if every row had been read at its frame's time stamp, which is that of the
/// principal point's row. Velocities are those of a smooth path through the poses of `motion`,
/// whose noise is that of the images as far as `rotations` are unknown. Sets `row_delay_moves_px`
/// if the delay has a standard deviation.
Window without_rolling_shutter(const Window& window,
                               const PlaneMotion& motion,
                               RotationModel rotations,
                               const RowDelayPrior& delay);

}  // namespace gpo
