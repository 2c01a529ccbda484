// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/csv_table.h"
#include "engine/recording/recording.h"

#include <filesystem>
#include <optional>

#include <Eigen/Core>

namespace gpo {

/// The samples of imu0/data.csv, gyro.csv or gyro_accel.csv: time stamp, then rates [rad/s] (or
/// [deg/s], where the header says so), then accelerations if there are any; further columns are
/// passed over. Axes and bias are left at their defaults. Throws InputError.
Gyroscope read_gyroscope(const std::filesystem::path& file, TimeUnit unit);

struct Gyroscope;

/// The gyroscope's axes in the body, its bias and how sure that is, and its noise, where the
/// sensor's file has them.
struct ImuCalibration {
  std::optional<Eigen::Matrix3d> R_body_gyro;
  std::optional<Eigen::Vector3d> bias_rad_s;
  std::optional<double> bias_sigma_rad_s;
  std::optional<double> noise_density;  ///< [rad/s/sqrt(Hz)]
};

/// EuRoC's imu0/sensor.yaml: `T_BS`, `gyroscope_bias`, `gyroscope_bias_sigma`,
/// `gyroscope_noise_density` (zero: not known), each optional. Throws InputError.
ImuCalibration read_imu_calibration(const std::filesystem::path& file);

/// Takes over what is said of the bias and the noise. `source` of the bias is for people.
void set_bias(Gyroscope& gyroscope, const ImuCalibration& calibration, const char* source);

}  // namespace gpo
