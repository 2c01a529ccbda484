// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inertial/preintegration.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A sensor's measurements between the frames of a window; or why there are none.
struct ImuIntervals {
  std::vector<Preintegration> between = {};  ///< one from each frame to the next
  std::string reason = "";
};

/// Of a gyroscope with accelerations, both linear between samples and held for a sample beyond
/// them, this bias taken off the rates and none off the accelerations. Frame times on the camera's
/// clock. A reason where samples do not cover the window, leave a gap of more than five periods in
/// it, or are not finite.
ImuIntervals imu_intervals(const Gyroscope& gyroscope,
                           std::span<const std::int64_t> frame_times_ns,
                           std::int64_t time_offset_ns,
                           const Eigen::Vector3d& bias_rad_s,
                           const ImuNoise& noise);

/// White noise of the accelerations between two times on the sensor's clock, as a density
/// [m/s^2/sqrt(Hz)]: by third differences of means over 10 ms, which hands and drones hardly move
/// in. A drone's vibration is ten times what its accelerometer's data sheet says. Nothing where
/// there are too few samples.
std::optional<double> accelerometer_noise_density(const Gyroscope& gyroscope,
                                                  std::int64_t first_ns,
                                                  std::int64_t last_ns);

}  // namespace gpo
