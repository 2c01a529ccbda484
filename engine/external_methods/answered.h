// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/external_methods/answer.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <optional>
#include <span>
#include <vector>

namespace gpo {

/// The answer as our methods deliver theirs: the world is the reference camera, the leading plane's
/// distance 1. Points that are not given are those on the plane, or where no plane is given either
/// triangulated; a plane that is not given is fitted to the inlier points; a camera that is null is
/// resected from the points. A failure that says why where that does not go, or where the result
/// does not fit the window's tracks, by which any method's is judged.
Initialization initialization_of(const Window& window, const Answer& answer);

/// What others leave open of a window, by our own means. All in one world, whichever it is.

/// The inlier tracks that two given cameras or more see and determine; one entry a frame.
std::vector<MapPoint> triangulated(const Window& window,
                                   std::span<const std::optional<Pose>> given);

/// The camera of a frame from the points that it sees; nothing where these are too few.
std::optional<Pose> resected(const Window& window, const std::vector<MapPoint>& points, int frame);

}  // namespace gpo
