// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

#include <optional>

namespace gpo {

/// The twin of a motion over a plane: of the two readings that the camera can see of each frame's
/// homography, those whose normals agree with the one that `motion` did not take in its widest
/// frame. Rotations, translations and normal are new; further planes are left out. Nothing where
/// the widest frame has one reading only.
std::optional<PlaneMotion> other_decomposition(const Window& window, const PlaneMotion& motion);

}  // namespace gpo
