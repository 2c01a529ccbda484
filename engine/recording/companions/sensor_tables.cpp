// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/files/yaml_entry.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/window/gyroscope.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

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

constexpr int kBiasColumn = 11;  // columns: t, p (3), q (4), v (3), b_w (3), b_a (3)
constexpr int kColumnsWithBias = 17;
constexpr double kMostSeconds = 1e6;

/// `q` has the columns of the quaternion's w, x, y, z; p is in columns 1 to 3.
Pose pose_of(const CsvTable& table, const CsvRow& row, const std::array<int, 4>& q) {
  const auto value = [&](int column) { return csv_number(table, row, column); };
  const Eigen::Quaterniond rotation(value(q[0]), value(q[1]), value(q[2]), value(q[3]));
  const double norm = rotation.norm();
  if (!(std::abs(norm - 1) <= 1e-2))
    csv_fail(table, row.line, "a quaternion of norm " + std::to_string(norm), "a unit quaternion");
  return {rotation.normalized().toRotationMatrix(), {value(1), value(2), value(3)}};
}

PosePath path_of(const CsvTable& table, TimeUnit unit, const std::array<int, 4>& quaternion) {
  PosePath path;
  path.timestamps_ns = csv_time_stamps(table, unit);
  path.longest_gap_ns = usual_longest_gap_ns(path.timestamps_ns);
  path.poses.reserve(table.rows.size());
  for (const auto& row : table.rows) path.poses.push_back(pose_of(table, row, quaternion));
  return path;
}

std::optional<Eigen::Vector3d> mean_bias(const CsvTable& table) {
  if (table.columns != kColumnsWithBias) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& row : table.rows)
    for (int i = 0; i < 3; ++i) sum[i] += csv_number(table, row, kBiasColumn + i);
  return sum / static_cast<double>(table.rows.size());
}

std::optional<std::int64_t> nanoseconds(const YamlEntry& root, const std::string& key) {
  const auto entry = find(root, key);
  if (!entry) return std::nullopt;
  const double seconds = number(*entry);
  if (std::abs(seconds) > kMostSeconds) yaml_fail(*entry, "seconds, at most 1e6");
  return std::llround(seconds * 1e9);
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

std::int64_t usual_longest_gap_ns(const std::vector<std::int64_t>& timestamps_ns) {
  return 3 * std::min(median_period_ns(timestamps_ns), INT64_MAX / 4);
}

PosePath read_euroc_path(const std::filesystem::path& file) {
  const CsvTable table =
      read_csv(file, {"timestamp", "px", "py", "pz", "qw", "qx", "qy", "qz"}, CsvColumns::at_least);
  PosePath path = path_of(table, TimeUnit::nanoseconds, {4, 5, 6, 7});
  path.mean_gyro_bias_rad_s = mean_bias(table);
  return path;
}

PosePath read_tum_path(const std::filesystem::path& file, TimeUnit unit) {
  const CsvTable table = read_csv(file,
                                  {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"},
                                  CsvColumns::exactly,
                                  Separator::blanks);
  return path_of(table, unit, {7, 4, 5, 6});
}

std::optional<Pose> pose_at(const PosePath& path, std::int64_t time_ns) {
  const auto& times = path.timestamps_ns;
  const auto after = std::lower_bound(times.begin(), times.end(), time_ns);
  if (after == times.end()) return std::nullopt;
  const auto b = after - times.begin();
  if (*after == time_ns) return path.poses[b];
  if (b == 0) return std::nullopt;
  const auto a = b - 1;
  if (times[b] - times[a] > path.longest_gap_ns) return std::nullopt;
  const double s =
      static_cast<double>(time_ns - times[a]) / static_cast<double>(times[b] - times[a]);
  const Pose& T_a = path.poses[a];
  const Pose& T_b = path.poses[b];
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(T_a.R_wc).slerp(s, Eigen::Quaterniond(T_b.R_wc)).normalized();
  return Pose{q.toRotationMatrix(), (1 - s) * T_a.p_wc + s * T_b.p_wc};
}

GroundTruth camera_truth(const PosePath& path,
                         const TruthMounting& mounting,
                         std::string source,
                         const std::vector<std::int64_t>& frame_times_ns) {
  GroundTruth truth;
  truth.source = std::move(source);
  truth.poses.reserve(frame_times_ns.size());
  for (const std::int64_t time : frame_times_ns) {
    const auto measured = pose_at(path, time + mounting.time_offset_ns);
    truth.poses.push_back(measured ? std::optional(*measured * mounting.T_measured_camera)
                                   : std::nullopt);
  }
  return truth;
}

void read_truth_clock(const std::filesystem::path& yaml, PosePath& path, TruthMounting& mounting) {
  const YamlEntry root = load_yaml(yaml);
  if (const auto offset = nanoseconds(root, "time_offset_s")) mounting.time_offset_ns = *offset;
  if (const auto gap = nanoseconds(root, "longest_gap_s")) path.longest_gap_ns = *gap;
}

void read_mounting_beside(const std::filesystem::path& folder,
                          PosePath& path,
                          TruthMounting& mounting) {
  const auto yaml = if_file(folder / "groundtruth.yaml");
  if (!yaml) return;
  read_truth_clock(*yaml, path, mounting);
  if (const auto T = find(load_yaml(*yaml), "T_truth_camera"))
    mounting.T_measured_camera = rigid_motion(*T);
}

std::optional<GroundTruth> truth_beside(const std::filesystem::path& folder,
                                        const std::vector<std::int64_t>& frame_times_ns) {
  const auto file = if_file(folder / "groundtruth.txt");
  if (!file) return std::nullopt;
  PosePath path = read_tum_path(*file);
  TruthMounting mounting;
  read_mounting_beside(folder, path, mounting);
  return camera_truth(path, mounting, file->filename().string(), frame_times_ns);
}

}  // namespace gpo
