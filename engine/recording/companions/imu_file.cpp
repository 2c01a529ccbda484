// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/imu_file.h"

#include "engine/files/yaml_entry.h"
#include "engine/recording/companions/calibration_file.h"
#include "engine/window/gyroscope.h"

#include <string>

namespace gpo {
namespace {

double positive_number(const YamlEntry& entry, const std::string& expected) {
  const double value = number(entry, expected);
  if (value <= 0) yaml_fail(entry, expected);
  return value;
}

}  // namespace

ImuCalibration read_imu_calibration(const std::filesystem::path& file) {
  ImuCalibration result;
  const auto root = load_yaml(file);
  if (const auto T_BS = find(root, "T_BS")) result.R_body_gyro = rigid_motion(*T_BS).R_wc;
  if (const auto bias = find(root, "gyroscope_bias")) {
    const auto b = numbers(*bias, 3, "3 (x, y, z) in rad/s");
    result.bias_rad_s = Eigen::Vector3d(b[0], b[1], b[2]);
  }
  if (const auto sigma = find(root, "gyroscope_bias_sigma"))
    result.bias_sigma_rad_s = positive_number(*sigma, "a positive number in rad/s");
  if (const auto density = find(root, "gyroscope_noise_density")) {
    const std::string expected = "a number that is not negative in rad/s/sqrt(Hz)";
    const double value = number(*density, expected);
    if (value < 0) yaml_fail(*density, expected);
    if (value > 0) result.noise_density = value;
  }
  return result;
}

void set_bias(Gyroscope& gyroscope, const ImuCalibration& calibration, const char* source) {
  if (calibration.bias_rad_s) {
    gyroscope.bias_rad_s = *calibration.bias_rad_s;
    gyroscope.bias_known = true;
    gyroscope.bias_source = source;
  }
  if (calibration.bias_sigma_rad_s) gyroscope.bias_sigma_rad_s = *calibration.bias_sigma_rad_s;
  if (calibration.noise_density) gyroscope.noise_density = *calibration.noise_density;
}

}  // namespace gpo
