// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/files/yaml_entry.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/window/gyroscope.h"

#include <numbers>
#include <string>

namespace gpo {
namespace {

double rad_s_per_unit(const CsvTable& table) {
  if (table.header.empty()) return 1;
  const std::string name = lower_case(table.header[1]);
  const bool degrees =
      name.find("deg") != std::string::npos || name.find("dps") != std::string::npos;
  return degrees ? std::numbers::pi / 180 : 1;
}

/// Returns whether columns 4 to 6 are accelerations: names in the header, if any, begin with "a".
bool has_accelerations(const CsvTable& table) {
  return table.columns >= 7 && (table.header.empty() || lower_case(table.header[4])[0] == 'a');
}

double positive_number(const YamlEntry& entry, const std::string& expected) {
  const double value = number(entry, expected);
  if (value <= 0) yaml_fail(entry, expected);
  return value;
}

}  // namespace

Gyroscope read_gyroscope(const std::filesystem::path& file, TimeUnit unit) {
  const CsvTable table = read_csv(file, {"timestamp", "wx", "wy", "wz"}, CsvColumns::at_least);
  Gyroscope gyroscope;
  gyroscope.file = file;
  gyroscope.timestamps_ns = csv_time_stamps(table, unit);
  gyroscope.lines.reserve(table.rows.size());
  gyroscope.rates_rad_s.reserve(table.rows.size());
  const double scale = rad_s_per_unit(table);
  const bool accelerations = has_accelerations(table);
  const auto vector = [&](const CsvRow& row, int column) {
    return Eigen::Vector3d(csv_number(table, row, column),
                           csv_number(table, row, column + 1),
                           csv_number(table, row, column + 2));
  };
  for (const auto& row : table.rows) {
    gyroscope.lines.push_back(row.line);
    gyroscope.rates_rad_s.emplace_back(scale * vector(row, 1));
    if (accelerations) gyroscope.accelerations_m_s2.push_back(vector(row, 4));
  }
  return gyroscope;
}

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
    const std::string expected = "a number >= 0 in rad/s/sqrt(Hz)";
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
