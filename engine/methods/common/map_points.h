// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <span>
#include <vector>

namespace gpo {

/// Map points without triangulation (engine/method.md, eq. 12): each inlier observation is
/// lifted to where its ray meets the plane, and a landmark is the mean over its frames. Inlier
/// tracks only; in the world of the poses.
std::vector<MapPoint> lift_to_plane(const Window& window,
                                    const Plane& plane,
                                    std::span<const Pose> cameras);

}  // namespace gpo
