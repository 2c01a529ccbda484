// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
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

/// Returns the window with the points where a lens without the residual would see them.
Window without_lens_residual(Window window, const LensResidual& residual);

/// Returns the window with the points where they were at the time stamps by the result's row delay.
/// They keep the lens residual, because an uneven surface looks like one.
Window as_seen_at_time_stamps(const Window& window, const Initialization& result);

/// Returns the motion of a result's cameras around each frame.
std::vector<RowMotion> row_motions(const Window& window, const Initialization& result);

/// Returns the velocities of a smooth path through the poses, whose noise is that of the images as
/// far as `rotations` are unknown.
std::vector<Velocity> velocities_of(const Window& window,
                                    const PlaneMotion& motion,
                                    RotationModel rotations);

}  // namespace gpo
