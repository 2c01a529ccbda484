// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"
#include "engine/window/gyroscope.h"

#include <functional>
#include <memory>
#include <stop_token>
#include <vector>

namespace gpo {

/// Estimates rotations of at most `most_windows` windows of about 0.3 s, spread over the recording,
/// from the images alone. Uses five-point rotations if the scene is more than a plane, else those
/// of the default method's cameras or its start, or those that explain the homographies if the
/// camera only rotates. Skips windows without rotations. Calls `progress(done, of)` after each.
/// Throws InputError if there are no tracks.
std::vector<ImageRotations> rotations_over_recording(
    const std::shared_ptr<const Recording>& recording,
    int most_windows = 80,
    const std::function<void(int, int)>& progress = {},
    const std::stop_token& stop = {});

}  // namespace gpo
