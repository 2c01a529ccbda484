// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/calibration/calibrate.h"
#include "engine/calibration/gyroscope_fit.h"
#include "engine/calibration/plane/plane_lens.h"

namespace gpo {

/// Formats a camera.yaml for `read_calibration`. `source` names the recording in a comment.
std::string to_yaml(const CameraCalibration& calibration, const std::string& source);
std::string to_yaml(const SelfCalibration& calibration, const std::string& source);
/// The same of an unchanged camera, with the fitted `T_BS` and `timeshift_cam_imu`.
std::string to_yaml(const GyroscopeFit& fit, const Camera& camera, const std::string& source);

std::string to_text(const CameraCalibration& calibration);
std::string to_text(const SelfCalibration& calibration);
std::string to_text(const GyroscopeFit& fit, const Gyroscope& recorded);

std::vector<Chart> gyroscope_charts(const std::vector<ImageRotations>& windows,
                                    const Gyroscope& gyroscope,
                                    const GyroscopeFit& fit);

/// A sentence if it differs by five standard deviations and by 5 deg or half a frame; else empty.
std::string why_it_does_not_fit(const GyroscopeFit& fit,
                                const Gyroscope& recorded,
                                double frame_period_s);

}  // namespace gpo
