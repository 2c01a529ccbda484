// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/csv_table.h"
#include "engine/files/text_file.h"
#include "engine/recording/loggers/logs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kMostHeadLines = 200;
constexpr std::size_t kMostRows = 8'000'000;

/// Gyroflow's own axes: x up, y left, z back, as seen from behind the camera.
Eigen::Matrix3d camera_in_gyroflow() {
  return (Eigen::Matrix3d() << 0, -1, 0, -1, 0, 0, 0, 0, -1).finished();
}

/// A value above the table, and its line.
struct HeadValue {
  std::string text;
  int line = 0;
};

struct GcsvFile {
  CsvTable table;  ///< its rows have at least four cells
  std::map<std::string, HeadValue> head;
  int head_lines = 0;
};

/// "t,gx,gy,gz,...", the rates under whatever letter.
bool names_columns(const CsvTable& table, std::string_view line) {
  const CsvRow row{0, line};
  if (lower_case(csv_cell(table, row, 0)) != "t") return false;
  for (int k = 0; k < 3; ++k) {
    const std::string_view name = csv_cell(table, row, 1 + k);
    if (name.empty() || std::tolower(static_cast<unsigned char>(name.back())) != 'x' + k)
      csv_fail(table, 0, "another column", "columns t,gx,gy,gz");
  }
  return true;
}

GcsvFile open_gcsv(const std::filesystem::path& file) {
  GcsvFile gcsv;
  gcsv.table.file = file;
  gcsv.table.text = std::make_shared<const std::string>(read_file(file));
  TextLines lines(*gcsv.table.text);
  const std::string_view first = lines.next().value_or("");
  if (!first.starts_with("GYROFLOW IMU LOG") && !first.starts_with("CAMERA IMU LOG"))
    csv_fail(gcsv.table, 1, "another first line", "GYROFLOW IMU LOG");
  for (bool in_head = true; in_head;) {
    const auto row = lines.next();
    const int line = lines.number() + (row ? 0 : 1);
    if (!row || line > kMostHeadLines) csv_fail(gcsv.table, line, "no table", "a line t,gx,gy,gz");
    in_head = !names_columns(gcsv.table, *row);
    const std::size_t comma = row->find(',');
    if (!in_head || comma == std::string_view::npos) continue;
    gcsv.head[lower_case(trimmed(row->substr(0, comma)))] = {
        std::string(trimmed(row->substr(comma + 1))), line};
  }
  gcsv.head_lines = lines.number();
  while (const auto row = lines.next()) {
    const int line = lines.number();
    if (row->empty()) continue;
    if (std::ranges::count(*row, ',') < 3)
      csv_fail(gcsv.table, line, "fewer than 4 columns", "t,gx,gy,gz");
    if (gcsv.table.rows.size() == kMostRows)
      csv_fail(gcsv.table, line, "one more row", fmt::format("at most {}", kMostRows));
    gcsv.table.rows.push_back({line, *row});
  }
  if (gcsv.table.rows.empty()) csv_fail(gcsv.table, lines.number(), "no rows", "t,gx,gy,gz");
  return gcsv;
}

std::optional<double> head_number(const GcsvFile& gcsv, const std::string& key) {
  const auto found = gcsv.head.find(key);
  if (found == gcsv.head.end()) return std::nullopt;
  const auto value = parse_number(found->second.text);
  if (!value) csv_fail(gcsv.table, found->second.line, "no number", key + ",NUMBER");
  return value;
}

double required_scale(const GcsvFile& gcsv, const std::string& key) {
  const auto value = head_number(gcsv, key);
  if (value && *value > 0) return *value;
  csv_fail(gcsv.table, gcsv.head_lines, "no " + key + " above the table", key + ",NUMBER, > 0");
}

/// gyroscope <- camera: row i of the orientation says which of the log's axes is Gyroflow's axis i.
Eigen::Matrix3d axes_of(const GcsvFile& gcsv) {
  const auto found = gcsv.head.find("orientation");
  const auto axes = signed_axes(found == gcsv.head.end() ? "XYZ" : found->second.text);
  if (!axes) {
    csv_fail(gcsv.table,
             found->second.line,
             "other axes",
             "orientation,AXES with three axes that turn to the right, such as YxZ");
  }
  return axes->transpose() * camera_in_gyroflow();
}

}  // namespace

Log read_gcsv(const std::filesystem::path& file) {
  constexpr double kMost_s = 4e9;
  const GcsvFile gcsv = open_gcsv(file);
  const CsvTable& table = gcsv.table;
  const double tscale = required_scale(gcsv, "tscale");
  const double gscale = required_scale(gcsv, "gscale");
  Log log;
  log.file = file;
  log.T_body_camera = Pose{axes_of(gcsv), Eigen::Vector3d::Zero()};
  Gyroscope gyroscope;
  gyroscope.file = file;
  for (const CsvRow& row : table.rows) {
    const double time_s = tscale * csv_number(table, row, 0);
    if (!(std::abs(time_s) < kMost_s)) csv_fail(table, row.line, "another time", "seconds");
    const std::int64_t time_ns = std::llround(1e9 * time_s);
    if (!gyroscope.timestamps_ns.empty() && time_ns <= gyroscope.timestamps_ns.back())
      csv_fail(table, row.line, "a time that is not after the one before it", "ascending times");
    const Eigen::Vector3d rates(
        csv_number(table, row, 1), csv_number(table, row, 2), csv_number(table, row, 3));
    gyroscope.timestamps_ns.push_back(time_ns);
    gyroscope.lines.push_back(row.line);
    gyroscope.rates_rad_s.emplace_back(gscale * rates);
    if (!gyroscope.rates_rad_s.back().allFinite())
      csv_fail(table, row.line, "a rate that is not finite", "numbers");
  }
  log.gyroscope = std::move(gyroscope);
  if (const auto readout_ms = head_number(gcsv, "frame_readout_time")) {
    const double direction = head_number(gcsv, "frame_readout_direction").value_or(0);
    if (direction == 0) log.readout_s = 1e-3 * *readout_ms;
    if (direction == 1) log.readout_s = -1e-3 * *readout_ms;
  }
  return log;
}

}  // namespace gpo
