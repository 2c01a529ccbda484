// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/frontend/rotations.h"
#include "engine/recording/recording.h"
#include "engine/window/window.h"

#include <stop_token>
#include <string>

namespace gpo {

/// What a recording lacks for this source of rotations, one line; empty: nothing.
std::string why_no_rotations(const Recording& recording, RotationSource source);

/// What `automatic` comes to: the gyroscope, else averaging. Throws InputError where the recording
/// lacks what is asked for.
RotationSource rotation_source_used(const Recording& recording, RotationSource asked);

/// The window's rotations from a source that the recording has; `truth` may be null for all but the
/// truth. Throws InputError where gyroscope or truth do not cover the window.
Rotations window_rotations(const Recording& recording,
                           const Window& window,
                           const WindowTruth* truth,
                           RotationSource source,
                           const std::stop_token& stop);

}  // namespace gpo
