// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

namespace gpo {

/// The result of a method over a plane, with its map points and their RMS; a failure where it is
/// not to be trusted.
Initialization checked_result(const Window& window, Initialization result);

/// What a method over a plane hands out: the visible one of the two solutions with its cameras and
/// map points, or a failure where the solution is not to be trusted.
Initialization make_result(const Window& window, const PlaneMotion& motion, const SolverReport& solver);

}  // namespace gpo
