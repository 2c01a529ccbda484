// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/homography_ransac.h"
#include "engine/frontend/rotations.h"
#include "engine/initialize.h"
#include "engine/initializers/common/initialization.h"
#include "engine/initializers/common/verdict.h"
#include "engine/window/window.h"

#include <span>
#include <stop_token>
#include <vector>

namespace gpo {

// From tracks to a verdict, step by step: `initialize` takes them at once, an Inspector keeps what
// each one made. Between them: `make_window`, `chosen_rotations`, the method, `assessed`.

/// What `ransac` comes to. Chosen, or by default on for the methods that need a plane and off for
/// those that use all tracks (ba, pnp_ba). Throws InputError for an unknown method.
bool uses_ransac(const InitializeOptions& options);

/// What `inliers` comes to. Throws InputError for an unknown method.
Inliers inliers_used(const InitializeOptions& options);

/// What `gravity` comes to. Only a method whose uncertainty is that of the very problem that it
/// solved, planes and cameras together, takes it into its solution; of others it is found after.
/// Throws InputError for an unknown method.
Gravity gravity_used(const InitializeOptions& options);

/// How a window is made. A method that needs no plane gets its start from the tracks on it even
/// where it then uses all.
RansacOptions ransac_options(const InitializeOptions& options);

/// The window as a method gets it, with these rotations, if there are any.
Window with_rotations(Window window, const Rotations& rotations, bool all_tracks);

/// Verdicts of the windows of 2, 3, ... frames, as the window grows.
std::vector<Verdict> growing_verdicts(const Window& window, const std::stop_token& stop);

/// The verdict of a result that has none: that of the whole window as it grew, if it did, or that
/// there is no plane.
void complete_verdict(const Window& window,
                      std::span<const Verdict> growth,
                      Initialization& result);

/// What rests on a guess of the lens may be wrong however well it fits.
void demote(Verdict& verdict);

}  // namespace gpo
