// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

#include <vector>

namespace gpo {

/// The window's planes beside the leading one, each by linear least squares from the cameras:
/// [x_i]x R_ciw tau_i (m.x_1) = [x_i]x R_ciw x_1 over its tracks and the frames (engine/method.md,
/// eq. 3), weighted to pixels by a first solution. A plane that the cameras' motion does not tell,
/// or that most of its tracks put behind the reference camera, is left out.
std::vector<OtherPlane> other_planes(const Window& window, const PlaneMotion& motion);

/// Their numbers.
std::vector<int> numbers_of(const std::vector<OtherPlane>& planes);

}  // namespace gpo
