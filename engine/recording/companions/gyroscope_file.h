// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/csv_table.h"
#include "engine/recording/recording.h"

#include <filesystem>
#include <optional>

#include <Eigen/Core>

namespace gpo {

/// Reads imu0/data.csv, gyro.csv or gyro_accel.csv: time stamp, rates [rad/s] (or [deg/s] according
/// to the header), optional accelerations; ignores further columns. Axes and bias keep their
/// defaults. Throws InputError.
Gyroscope read_gyroscope(const std::filesystem::path& file, TimeUnit unit);

/// Axes, bias and noise of a gyroscope, as far as its sensor file has them.
struct ImuCalibration {
  std::optional<Eigen::Matrix3d> R_body_gyro;
  std::optional<Eigen::Vector3d> bias_rad_s;
  std::optional<double> bias_sigma_rad_s;
  std::optional<double> noise_density;  ///< [rad/s/sqrt(Hz)]
};

/// Reads EuRoC's imu0/sensor.yaml: `T_BS`, `gyroscope_bias`, `gyroscope_bias_sigma`,
/// `gyroscope_noise_density` (zero: unknown), each optional. Throws InputError.
ImuCalibration read_imu_calibration(const std::filesystem::path& file);

/// Applies bias and noise. `source` of the bias is for people.
void set_bias(Gyroscope& gyroscope, const ImuCalibration& calibration, const char* source);

}  // namespace gpo
