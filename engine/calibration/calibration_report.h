// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/calibrate.h"

#include <string>

namespace gpo {

/// camera.yaml as `read_calibration` reads it, with the standard deviations under keys of their
/// own. `source`: what was calibrated, for people.
std::string to_yaml(const CameraCalibration& calibration, const std::string& source);

/// A table for people, each line ended: each parameter with its standard deviation, what was used,
/// warnings.
std::string to_text(const CameraCalibration& calibration);

}  // namespace gpo
