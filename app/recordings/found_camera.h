// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/self_calibration.h"
#include "engine/recording/recording.h"

#include <memory>
#include <stop_token>

namespace gpo {

/// With a progress bar on standard error; from the recording's guess, or a field of view of 70
/// degrees where it has another camera, which is not to be believed. Throws Interrupted.
SelfCalibration self_calibrate(const Recording& recording);

/// The recording with the camera that is found in its pictures, which is kept in the user's cache;
/// null where it was stopped. Throws InputError with the reason where none is found.
std::shared_ptr<const Recording> self_calibrated(const Recording& recording,
                                                 const std::stop_token& stop,
                                                 const CalibrationProgress& progress);

/// Gives a recording the camera that was found in the same pictures before, from the user's cache;
/// where there is none and `calibrates`, finds one now and keeps it there. Where it cannot be
/// found, a note says why and the guess stays.
void use_found_camera(Recording& recording, bool calibrates);

}  // namespace gpo
