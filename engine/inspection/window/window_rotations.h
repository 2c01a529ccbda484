// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/pipeline/pipeline.h"
#include "engine/recording/recording.h"
#include "engine/truth/truth.h"
#include "engine/window/window.h"

#include <stop_token>
#include <string>

namespace gpo {

/// What a recording lacks for this source of rotations, one line; empty: nothing.
std::string why_no_rotations(const Recording& recording, RotationSource source);

/// What `automatic` tries first: the calibrated gyroscope, else five-point rotations. Throws
/// InputError where the recording lacks what is asked for.
RotationSource rotation_source_used(const Recording& recording, RotationSource asked);

/// What `automatic` may come to, for people: "gyro-calibrated", "five-point or averaging".
std::string automatic_rotations(const Recording& recording);

/// `chosen_rotations` of a recording's window. `truth` may be null for all but the truth. Throws
/// InputError where the recording lacks what is asked for, and where gyroscope or truth do not
/// cover the window.
ChosenRotations window_rotations(const Recording& recording,
                                 const Window& window,
                                 const WindowTruth* truth,
                                 RotationSource asked,
                                 const RansacOptions& ransac,
                                 const std::stop_token& stop);

}  // namespace gpo
