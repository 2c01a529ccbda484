// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

namespace gpo {

/// The paper's first baseline: decomposes the homography of one pair, the widest that can be
/// trusted, triangulates its points, and adds the other frames one by one, in order, by
/// perspective-n-point and triangulation (Lepetit et al. 2009). The window's rotations only tell
/// the true reading of the pair from its twin. Delivers the triangulated inlier tracks as they are;
/// gauge and normal are those of the plane through them.
Initialization initialize_pnp(const Window& window, const Watch& watch);

}  // namespace gpo
