// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/calibration/calibrate.h"
#include "engine/calibration/gyroscope_fit.h"
#include "engine/calibration/plane/plane_lens.h"

namespace gpo {

/// Formats a camera.yaml for `read_calibration`, with standard deviations under keys of their own.
/// `source` names the recording in a comment.
std::string to_yaml(const CameraCalibration& calibration, const std::string& source);
std::string to_yaml(const PlaneLens& lens, const std::string& source);
/// The same of an unchanged camera, with the fitted `T_BS` and `timeshift_cam_imu`. `lever_arm_m`:
/// the camera in the gyroscope's axes, zero if unknown.
std::string to_yaml(const GyroscopeFit& fit,
                    const Camera& camera,
                    const std::string& source,
                    const Eigen::Vector3d& lever_arm_m);

/// Formats a table for people, one parameter or fact a line.
std::string to_text(const CameraCalibration& calibration);
std::string to_text(const PlaneLens& lens);
std::string to_text(const GyroscopeFit& fit, const Gyroscope& recorded);

/// Formats the differences of a camera from that of the recording, one parameter a line, with the
/// standard deviations of both.
std::string comparison_text(const Camera& found, const Camera& recorded);

/// Angular rates over time in camera axes, by images and by the gyroscope before and after the fit,
/// and their differences.
std::vector<Chart> gyroscope_charts(const std::vector<ImageRotations>& windows,
                                    const Gyroscope& gyroscope,
                                    const GyroscopeFit& fit);

/// A sentence if rotation or clock differ from the recording's by five standard deviations and by
/// more than 5 deg or half a frame, or if nothing explains the images; empty otherwise.
std::string why_it_does_not_fit(const GyroscopeFit& fit,
                                const Gyroscope& recorded,
                                double frame_period_s);

}  // namespace gpo
