// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

#include <optional>
#include <string>

namespace gpo {

/// Returns the window with the gyroscope's rotations before its calibration from the images, which
/// may have selected the wrong one of a plane's two decompositions. nullopt without one.
std::optional<Window> with_prior_bias(const Window& window);

/// Returns the window with clocks of camera and gyroscope that agree exactly.
Window with_exact_clock(Window window);

/// Returns why the estimated bias of the gyroscope shows a wrong minimum; empty if it does not.
std::string why_implausible_bias(const Window& window, const PlaneMotion& motion);

}  // namespace gpo
