// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/smooth_path.h"
#include "engine/window/window.h"

#include <span>
#include <vector>

namespace gpo {

/// Standard deviation of an unknown readout time of the whole image [s].
inline constexpr double kReadoutSigma_s = 0.02;

/// Returns the prior of an unknown row delay.
RowDelayPrior unknown_row_delay(const Window& window);

/// Corrects the inliers of a window for rolling shutter (engine/method.md, eq. 11): moves them to
/// where they would be if every row had been read at its frame's time stamp (`Window::rows`).
/// `velocities`: one per frame. Sets `row_delay_moves_px` if the delay has a standard deviation.
Window without_rolling_shutter(const Window& window,
                               const PlaneMotion& motion,
                               std::span<const Velocity> velocities,
                               const RowDelayPrior& delay);
/// Does the same with `velocities_of` the motion.
Window without_rolling_shutter(const Window& window,
                               const PlaneMotion& motion,
                               RotationModel rotations,
                               const RowDelayPrior& delay);

/// Returns the velocities of a smooth path through the poses, whose noise is that of the images as
/// far as `rotations` are unknown.
std::vector<Velocity> velocities_of(const Window& window,
                                    const PlaneMotion& motion,
                                    RotationModel rotations);

}  // namespace gpo
