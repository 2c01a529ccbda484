// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/rotations.h"
#include "engine/inertial/uncertain_poses.h"
#include "engine/initialize.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace gpo {

// The stages from tracks to a verdict, in their order; each takes and returns plain values:
//
//   window_of, chosen_rotations, with_rotations, run_method, growing_verdicts, finished
//
// `initialize`, and with it the live `LiveInitializer`, runs them in a row. An Inspector runs the
// same ones and caches the results of each.

/// Returns the window of the tracks: undistorted, with inliers, homographies and planes. Rotations
/// are left at the identity. `timestamps_ns` are those of all frames of the recording.
Window window_of(const Tracks& tracks,
                 const Camera& camera,
                 std::span<const std::int64_t> timestamps_ns,
                 const InitializeOptions& options);

/// Returns the window as a method gets it, with these rotations, if there are any.
Window with_rotations(Window window, const Rotations& rotations, const InitializeOptions& options);

/// Returns what the method makes of the window, without assessment; a failure if there are no
/// rotations. Throws InputError for an unknown method.
Initialization run_method(const Window& window,
                          const Rotations& rotations,
                          const Sources& sources,
                          const InitializeOptions& options,
                          const Watch& watch);

/// Returns the verdicts of the windows of 2, 3, ... frames, as the window grows.
std::vector<Verdict> growing_verdicts(const Window& window, const std::stop_token& stop);

/// The end of the pipeline.
struct Finished {
  Initialization initialization;  ///< with its uncertainty and the verdict on the window
  /// Gravity and meters; nullopt if the initialization failed, they are not requested or there is
  /// no accelerometer.
  std::optional<InertialAlignment> inertial = std::nullopt;
  UncertainPoses poses = {};  ///< from which these were found
};

/// Assesses a method's result, finds gravity and completes the verdict. `growth` gives a failed
/// result its verdict: it may be empty where the result is ok or brings one.
Finished finished(const Window& window,
                  const Sources& sources,
                  const InitializeOptions& options,
                  std::span<const Verdict> growth,
                  Initialization result);

/// Lowers `ready` to `weak`: what rests on a guess of the lens may be wrong however well it fits.
void demote(Verdict& verdict);

}  // namespace gpo
