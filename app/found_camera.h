// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/self_calibration.h"
#include "engine/recording/recording.h"

namespace gpo {

/// With a progress bar on standard error; from a field of view of 70 degrees, whatever camera the
/// recording has. Throws Interrupted.
SelfCalibration self_calibrate(const Recording& recording);

/// Gives a recording the camera that was found in the same pictures before, from the user's cache;
/// where there is none and `calibrates`, finds one now and keeps it there. Where it cannot be
/// found, a note says why and the guess stays.
void use_found_camera(Recording& recording, bool calibrates);

}  // namespace gpo
