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

/// Rotations of windows of about 0.3 s, spread over the recording, so many at most, one after the
/// other,
/// from the pictures alone: five-point rotations where the scene is more than a plane, else those
/// of the cameras that the default method finds, or would have started from; where the camera does
/// nothing but turn, those that explain the homographies. Windows that tell nothing are left out.
/// `progress(done, of)` is called after each. Throws InputError where there is nothing to track.
std::vector<ImageRotations> rotations_over_recording(
    const std::shared_ptr<const Recording>& recording,
    int most_windows = 80,
    const std::function<void(int, int)>& progress = {},
    const std::stop_token& stop = {});

}  // namespace gpo
