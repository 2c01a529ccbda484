// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/calibration/gyroscope_fit.h"
#include "engine/geometry/camera.h"

#include <string>
#include <vector>

namespace gpo {

/// A camera.yaml: the camera as it is, `T_BS` and `timeshift_cam_imu` as fitted.
std::string to_yaml(const GyroscopeFit& fit, const Camera& camera, const std::string& source);

/// For people, one line a fact.
std::string to_text(const GyroscopeFit& fit, const Gyroscope& recorded);

/// Rates about the camera's axes: pictures, gyroscope before and after; then what is left of each.
std::vector<Chart> gyroscope_charts(const RatesOverTime& rates);

/// Where rotation or clock are off what the recording says by five standard deviations and more
/// than matters (5 deg, half a frame): one sentence; empty: they fit, or nothing tells.
std::string why_it_does_not_fit(const GyroscopeFit& fit,
                                const Gyroscope& recorded,
                                double frame_period_s);

/// Angle between two rotations [deg].
double rotation_between_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

}  // namespace gpo
