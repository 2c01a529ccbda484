// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/csv_table.h"
#include "engine/files/text_file.h"
#include "engine/recording/loggers/logs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// By the table's header.
int column_of(const CsvTable& table, const std::string& name) {
  const auto same = [&](const std::string& cell) { return lower_case(trimmed(cell)) == name; };
  const auto found = std::ranges::find_if(table.header, same);
  if (found == table.header.end()) {
    throw InputError(
        fmt::format("{}: found no column \"{}\", expected one", table.file.string(), name));
  }
  return static_cast<int>(found - table.header.begin());
}

/// `names` are the columns of the time [s] and of the three rates [rad/s].
Gyroscope gyroscope_of(const CsvTable& table, const std::array<std::string, 4>& names) {
  constexpr int kDecimals = 9;
  std::array<int, 4> columns{};
  for (int k = 0; k < 4; ++k) columns[k] = column_of(table, names[k]);
  Gyroscope gyroscope;
  gyroscope.file = table.file;
  for (const CsvRow& row : table.rows) {
    const auto time_ns = parse_decimal(csv_cell(table, row, columns[0]), kDecimals);
    if (!time_ns) csv_fail(table, row.line, "no time stamp", "seconds as " + names[0]);
    if (!gyroscope.timestamps_ns.empty() && *time_ns <= gyroscope.timestamps_ns.back())
      csv_fail(table, row.line, "a time that is not after the one before it", "ascending times");
    gyroscope.timestamps_ns.push_back(*time_ns);
    gyroscope.lines.push_back(row.line);
    gyroscope.rates_rad_s.emplace_back(csv_number(table, row, columns[1]),
                                       csv_number(table, row, columns[2]),
                                       csv_number(table, row, columns[3]));
  }
  return gyroscope;
}

Camera camera_of(const fs::path& file) {
  const CsvTable table = read_csv(file, {"", "", ""}, CsvColumns::exactly);
  const auto at = [&](std::size_t row, int column) {
    return csv_number(table, table.rows[row], column);
  };
  if (table.rows.size() != 3 || !(at(0, 0) > 0) || !(at(1, 1) > 0))
    csv_fail(table, table.rows.back().line, "another matrix", "3 rows: fx 0 cx, 0 fy cy, 0 0 1");
  return {0, 0, at(0, 0), at(1, 1), at(0, 2), at(1, 2), Distortion::none, {}};
}

/// ARKit's poses with the camera's axes turned to ours, as the app stores them.
void add_odometry(Log& log, const fs::path& file) {
  const CsvTable table = read_csv(
      file, {"timestamp", "frame", "x", "y", "z", "qx", "qy", "qz", "qw"}, CsvColumns::at_least);
  log.frame_times_ns = csv_time_stamps(table, TimeUnit::seconds);
  for (const CsvRow& row : table.rows) {
    const auto value = [&](int column) { return csv_number(table, row, column); };
    const Eigen::Quaterniond q(value(8), value(5), value(6), value(7));
    const double norm = q.norm();
    if (!(std::abs(norm - 1) <= 1e-2)) {
      csv_fail(
          table, row.line, "a quaternion of norm " + std::to_string(norm), "a unit quaternion");
    }
    log.true_poses.push_back(
        Pose{q.normalized().toRotationMatrix(), {value(2), value(3), value(4)}});
  }
}

Pose rear_camera() { return {rear_camera_in_phone(), Eigen::Vector3d::Zero()}; }

}  // namespace

Log read_sensor_logger(const fs::path& file) {
  Log log;
  log.file = file;
  log.gyroscope = gyroscope_of(read_csv(file, {"timestamp"}, CsvColumns::at_least),
                               {"seconds_elapsed", "x", "y", "z"});
  log.T_body_camera = rear_camera();
  log.notes.emplace_back(
      "Gyroscope.csv: what has elapsed there is taken as the video's time, and the camera as a "
      "phone's rear one");
  return log;
}

Log read_stray_scanner(const fs::path& folder) {
  Log log;
  log.file = folder / "imu.csv";
  log.camera_file = folder / "camera_matrix.csv";
  log.camera = camera_of(log.camera_file);
  log.frames_file = folder / "odometry.csv";
  add_odometry(log, log.frames_file);
  std::error_code error;
  if (!fs::is_regular_file(log.file, error)) return log;
  log.gyroscope = gyroscope_of(read_csv(log.file, {"timestamp"}, CsvColumns::at_least),
                               {"timestamp", "alpha_x", "alpha_y", "alpha_z"});
  log.T_body_camera = rear_camera();
  return log;
}

}  // namespace gpo
