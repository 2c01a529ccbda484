// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/initializers/common/initialization.h"
#include "engine/window/window.h"

#include <optional>
#include <span>
#include <vector>

namespace gpo {

/// What others leave open of a window, by our own means. All in one world, whichever it is.

/// The inlier tracks that two given cameras or more see and determine; one entry a frame.
std::vector<MapPoint> triangulated(const Window& window,
                                   std::span<const std::optional<Pose>> given);

/// The camera of a frame from the points that it sees; nothing where these are too few.
std::optional<Pose> resected(const Window& window, const std::vector<MapPoint>& points, int frame);

}  // namespace gpo
