// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initializers/common/sources.h"
#include "engine/results/result_poses.h"
#include "engine/window/window.h"

#include <optional>
#include <vector>

namespace gpo {

/// A result's cameras, one a frame of the window, nothing where it has none; in the result's world.
/// By time: the nearest pose within half a frame; by number: of the same number in the recording;
/// by name: of the same picture, or of one whose name is the frame's time stamp [ns]. Poses of the
/// body become the camera's by the recording's T_BS. Throws InputError where that is not known, or
/// where two pictures of the result have a frame's name.
std::vector<std::optional<Pose>> found_cameras(const ResultPoses& result,
                                               PosedFrame frame,
                                               const Window& window,
                                               const Sources& sources);

}  // namespace gpo
