// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/rotations/rotations.h"
#include "engine/window/window.h"

#include <functional>

namespace gpo {

/// A method's result and the window that it was computed from.
struct MethodRun {
  Window window;
  Initialization result;
};

/// Runs a method with the rotations of both orientations of an ambiguous window and returns the
/// result that fits the tracks better, with `Initialization::ambiguity`. Another minimum that the
/// method itself compared (`other_minimum`) counts as well, because its choice may rest on noise.
/// `window` has `Rotations::R_wc`; the returned one has those nearer to the result.
MethodRun run_from_both(Window window,
                        const Rotations& rotations,
                        const std::function<Initialization(const Window&)>& run);

/// Returns by how many standard deviations the tracks fit solution `a` better than `b` (Vuong's
/// test of two models, 1989; engine/method.md, eq. 6c). Each track is one sample, because its
/// errors in all frames may be correlated.
double preference_sigmas(const Window& window, const RefusedSolution& a, const RefusedSolution& b);

}  // namespace gpo
