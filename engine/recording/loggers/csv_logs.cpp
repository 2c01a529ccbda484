// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/loggers/logs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace gpo {
namespace {

constexpr int kMostHeadLines = 200;
constexpr double kMostTime_s = 4e9;
constexpr double kStandardGravity_m_s2 = 9.80665;

/// Rotation of the rear camera (x from the phone's top to its bottom) in a phone's axes (x right, y
/// up, z out of the screen), and in Gyroflow's (x up, y left, z back).
Eigen::Matrix3d rear_camera() {
  return (Eigen::Matrix3d() << 0, -1, 0, -1, 0, 0, 0, 0, -1).finished();
}

void add_sample(Gyroscope& gyroscope,
                const CsvTable& table,
                const CsvRow& row,
                std::int64_t time_ns,
                const Eigen::Vector3d& rates_rad_s) {
  if (!gyroscope.timestamps_ns.empty() && time_ns <= gyroscope.timestamps_ns.back())
    csv_fail(table, row.line, "a time that is not later than the previous one", "ascending times");
  if (!rates_rad_s.allFinite()) csv_fail(table, row.line, "a rate that is not finite", "numbers");
  gyroscope.timestamps_ns.push_back(time_ns);
  gyroscope.lines.push_back(row.line);
  gyroscope.rates_rad_s.push_back(rates_rad_s);
}

std::optional<int> column_if(const CsvTable& table, const std::string& name) {
  const auto found = std::ranges::find(
      table.header, name, [](const std::string& cell) { return lower_case(trimmed(cell)); });
  if (found == table.header.end()) return std::nullopt;
  return static_cast<int>(found - table.header.begin());
}

int column_of(const CsvTable& table, const std::string& name) {
  if (const auto column = column_if(table, name)) return *column;
  refuse(table.file, "missing column \"{}\"", name);
}

Gyroscope gyroscope_of(CsvTable& table, const std::array<std::string, 4>& names) {
  std::array<int, 4> columns{};
  for (int k = 0; k < 4; ++k) columns[k] = column_of(table, names[k]);
  Gyroscope gyroscope;
  for (int k = 1; k < 4; ++k) gyroscope.left_out += drop_unmeasured(table, columns[k], 1);
  gyroscope.file = table.file;
  for (const CsvRow& row : table.rows) {
    const auto time_ns = parse_decimal(csv_cell(table, row, columns[0]), 9);
    if (!time_ns) csv_fail(table, row.line, "no time stamp", "seconds as " + names[0]);
    const auto rate = [&](int k) { return csv_number(table, row, columns[k]); };
    add_sample(gyroscope, table, row, *time_ns, {rate(1), rate(2), rate(3)});
  }
  return gyroscope;
}

Camera camera_of(const fs::path& file) {
  const CsvTable table = read_csv(file, {"", "", ""}, CsvColumns::exactly);
  const auto at = [&](std::size_t row, int column) {
    return csv_number(table, table.rows[row], column);
  };
  if (table.rows.size() != 3 || !(at(0, 0) > 0) || !(at(1, 1) > 0))
    csv_fail(table,
             table.rows.back().line,
             "a matrix of another form",
             "3 rows: fx 0 cx, 0 fy cy, 0 0 1");
  return {.fx = at(0, 0), .fy = at(1, 1), .cx = at(0, 2), .cy = at(1, 2)};
}

/// Reads ARKit's poses, which the app stores with the camera's axes converted to ours.
void add_odometry(Log& log, const fs::path& file) {
  const CsvTable table = read_csv(
      file, {"timestamp", "frame", "x", "y", "z", "qx", "qy", "qz", "qw"}, CsvColumns::at_least);
  log.frame_times_ns = csv_time_stamps(table, TimeUnit::seconds);
  for (const CsvRow& row : table.rows)
    log.true_poses.push_back(csv_pose(table, row, 2, {8, 5, 6, 7}));
}

/// Reads the times and, except for ADVIO's, the first frame's lens: time, number, fx, fy, cx, cy.
void add_frames(Log& log, const fs::path& file) {
  constexpr double kMostChange = 5e-3;
  constexpr int kCommas = 5;
  const CsvTable table = read_csv(file, {"timestamp", ""}, CsvColumns::at_least);
  log.frames_file = file;
  log.frame_times_ns = csv_time_stamps(table, TimeUnit::seconds);
  const auto has_lens = [](const CsvRow& row) {
    return std::ranges::count(row.text, ',') >= kCommas;
  };
  if (!std::ranges::all_of(table.rows, has_lens)) return;
  log.camera_file = file;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const CsvRow& row : table.rows) {
    const double fx = csv_number(table, row, 2);
    if (!is_focal_length(fx) || !is_focal_length(csv_number(table, row, 3)))
      csv_fail(table, row.line, "an implausible focal length", "pixels, > 0");
    least = std::min(least, fx);
    most = std::max(most, fx);
  }
  const auto first = [&](int column) { return csv_number(table, table.rows.front(), column); };
  log.camera = {.fx = first(2), .fy = first(3), .cx = first(4), .cy = first(5)};
  if (most > (1 + kMostChange) * least)
    log.notes.push_back(
        fmt::format("{}: the focal length varies from {:.1f} to {:.1f} px; using the "
                    "first frame's",
                    file.filename().string(),
                    least,
                    most));
}

/// Reads poses at the times of the frames. `R_body_camera` is the camera in the axes of the poses.
void add_poses(Log& log, const fs::path& file, const Eigen::Matrix3d& R_body_camera) {
  CsvTable table = read_csv(file, {"timestamp", "", "", "", "", "", "", ""}, CsvColumns::at_least);
  PosePath path;
  if (const int count = drop_unmeasured(table, 1, 7); count > 0)
    log.notes.push_back(fmt::format(
        "{}: {} left out: not finite", file.filename().string(), counted(count, "pose")));
  path.timestamps_ns = csv_time_stamps(table, TimeUnit::seconds);
  path.longest_gap_ns = usual_longest_gap_ns(path.timestamps_ns);
  for (const CsvRow& row : table.rows) {
    Pose pose = csv_pose(table, row, 1, {4, 5, 6, 7});
    pose.R_wc = pose.R_wc * R_body_camera;
    path.poses.push_back(pose);
  }
  for (const std::int64_t time : log.frame_times_ns) log.true_poses.push_back(pose_at(path, time));
  log.truth_file = file;
}

/// Reads a sensor's time, x, y and z without the rows whose time does not advance, as iOS writes
/// some.
CsvTable phone_samples(const fs::path& file) {
  CsvTable table = read_csv(file, {"timestamp", "", "", ""}, CsvColumns::at_least);
  std::optional<std::int64_t> last_ns;
  std::erase_if(table.rows, [&](const CsvRow& row) {
    const auto time_ns = parse_decimal(csv_cell(table, row, 0), 9);
    if (!time_ns) csv_fail(table, row.line, "no time stamp", "seconds");
    if (last_ns && *time_ns <= *last_ns) return true;
    last_ns = time_ns;
    return false;
  });
  return table;
}

/// Adds the poses of ARKit's camera, whose y is up and z backward, or of ADVIO, in the phone's
/// axes.
void add_phone_poses(Log& log, const fs::path& folder) {
  if (const auto arkit = if_file(folder / "ARposes.txt"))
    return add_poses(log, *arkit, Eigen::Vector3d(1, -1, -1).asDiagonal().toDenseMatrix());
  const fs::path above = fs::absolute(folder).lexically_normal() / ".." / "ground-truth";
  if (const auto file = first_file({above / "pose.csv", above / "poses.csv", folder / "arkit.csv"}))
    add_poses(log, file->lexically_normal(), rear_camera());
}

/// Adds specific forces in m/s^2, or accelerations as iOS has them: in g, downward at rest. Ignores
/// those without gravity. `first` is the column of x.
void add_forces(Gyroscope& gyroscope,
                const CsvTable& table,
                int first,
                const std::vector<std::int64_t>& times_ns) {
  constexpr double kLeastInG = 0.5, kMostInG = 3;
  AccelerationSamples samples;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const CsvRow& row = table.rows[i];
    if (!is_measured(table, row, first, 3)) continue;
    samples.timestamps_ns.push_back(times_ns[i]);
    samples.specific_force.push_back(csv_vector(table, row, first));
    lengths.push_back(samples.specific_force.back().norm());
  }
  if (lengths.empty()) return;
  const double length = median(std::move(lengths));
  if (!(length > kLeastInG)) return;
  if (length < kMostInG)
    for (Eigen::Vector3d& force : samples.specific_force) force *= -kStandardGravity_m_s2;
  add_accelerations(samples, gyroscope);
}

struct GcsvFile {
  CsvTable table;                      ///< its rows have at least four cells
  std::map<std::string, CsvRow> head;  ///< lines and texts of values by key
  int head_lines = 0;
};

/// Returns whether a line is "t,gx,gy,gz,...", with any letters in place of g.
bool names_columns(const CsvTable& table, std::string_view line) {
  const CsvRow row{0, line};
  if (lower_case(csv_cell(table, row, 0)) != "t") return false;
  for (int k = 0; k < 3; ++k) {
    const std::string_view name = csv_cell(table, row, 1 + k);
    if (name.empty() || std::tolower(static_cast<unsigned char>(name.back())) != 'x' + k)
      csv_fail(table, 0, "different columns", "columns t,gx,gy,gz");
  }
  return true;
}

void read_head(GcsvFile& gcsv, TextLines& lines) {
  const std::string_view first = lines.next().value_or("");
  if (!first.starts_with("GYROFLOW IMU LOG") && !first.starts_with("CAMERA IMU LOG"))
    csv_fail(gcsv.table, 1, "a different first line", "GYROFLOW IMU LOG");
  for (bool in_head = true; in_head;) {
    const auto row = lines.next();
    const int line = lines.number() + (row ? 0 : 1);
    if (!row || line > kMostHeadLines) csv_fail(gcsv.table, line, "no table", "a line t,gx,gy,gz");
    in_head = !names_columns(gcsv.table, *row);
    const std::size_t comma = row->find(',');
    if (!in_head || comma == std::string_view::npos) continue;
    gcsv.head[lower_case(trimmed(row->substr(0, comma)))] = {line, trimmed(row->substr(comma + 1))};
  }
  gcsv.head_lines = lines.number();
}

GcsvFile open_gcsv(const fs::path& file) {
  const Budget budget(file);
  GcsvFile gcsv;
  gcsv.table.file = file;
  gcsv.table.text = std::make_shared<const std::string>(read_file(file));
  TextLines lines(*gcsv.table.text);
  read_head(gcsv, lines);
  while (const auto row = lines.next()) {
    const int line = lines.number();
    if (row->empty()) continue;
    if (std::ranges::count(*row, ',') < 3)
      csv_fail(gcsv.table, line, "fewer than 4 columns", "t,gx,gy,gz");
    spend_items(file);
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

/// Returns gyroscope <- camera: row i of the orientation is the log's axis for Gyroflow's axis i.
Eigen::Matrix3d axes_of(const GcsvFile& gcsv) {
  const auto found = gcsv.head.find("orientation");
  const auto axes = signed_axes(found == gcsv.head.end() ? "XYZ" : found->second.text);
  if (!axes)
    csv_fail(gcsv.table,
             found->second.line,
             "invalid axes",
             "orientation,AXES with three right-handed axes such as YxZ");
  return axes->transpose() * rear_camera();
}

}  // namespace

Log read_sensor_logger(const fs::path& file) {
  Log log;
  log.file = file;
  CsvTable table = read_csv(file, {"timestamp"}, CsvColumns::at_least);
  log.gyroscope = gyroscope_of(table, {"seconds_elapsed", "x", "y", "z"});
  log.T_body_camera = Pose{rear_camera(), Eigen::Vector3d::Zero()};
  log.notes.emplace_back(
      "Gyroscope.csv: assuming that its elapsed seconds are the video's time and that the camera "
      "is the phone's rear one");
  return log;
}

Log read_ios_logger(const fs::path& folder) {
  Log log;
  const auto frames = first_file({folder / "Frames.txt", folder / "frames.csv"});
  if (!frames) refuse(folder, "found no Frames.txt or frames.csv");
  add_frames(log, *frames);
  log.file = *frames;
  add_phone_poses(log, folder);
  const auto rates =
      first_file({folder / "Gyro.txt", folder / "gyro.csv", folder / "gyroscope.csv"});
  if (!rates) return log;
  CsvTable table = phone_samples(*rates);
  Gyroscope& gyroscope = log.gyroscope.emplace();
  gyroscope.left_out = drop_unmeasured(table, 1, 3);
  gyroscope.file = log.file = *rates;
  const auto times_ns = csv_time_stamps(table, TimeUnit::seconds);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    add_sample(gyroscope, table, table.rows[i], times_ns[i], csv_vector(table, table.rows[i], 1));
  if (const auto file = first_file({folder / "Accel.txt", folder / "accelerometer.csv"})) {
    const CsvTable forces = phone_samples(*file);
    add_forces(gyroscope, forces, 1, csv_time_stamps(forces, TimeUnit::seconds));
  }
  log.T_body_camera = Pose{rear_camera(), Eigen::Vector3d::Zero()};
  log.notes.push_back(rates->filename().string() +
                      ": assuming the phone's axes and that the camera is its rear one");
  return log;
}

Log read_stray_scanner(const fs::path& folder) {
  Log log;
  log.file = folder / "imu.csv";
  log.camera_file = folder / "camera_matrix.csv";
  log.camera = camera_of(log.camera_file);
  log.frames_file = folder / "odometry.csv";
  add_odometry(log, log.frames_file);
  if (!is_file(log.file)) return log;
  CsvTable table = read_csv(log.file, {"timestamp"}, CsvColumns::at_least);
  log.gyroscope = gyroscope_of(table, {"timestamp", "alpha_x", "alpha_y", "alpha_z"});
  if (const auto first = column_if(table, "a_x"))
    add_forces(*log.gyroscope, table, *first, log.gyroscope->timestamps_ns);
  log.T_body_camera = Pose{rear_camera(), Eigen::Vector3d::Zero()};
  return log;
}

Log read_gcsv(const fs::path& file) {
  GcsvFile gcsv = open_gcsv(file);
  CsvTable& table = gcsv.table;
  const double tscale = required_scale(gcsv, "tscale");
  const double gscale = required_scale(gcsv, "gscale");
  Log log;
  log.file = file;
  log.T_body_camera = Pose{axes_of(gcsv), Eigen::Vector3d::Zero()};
  const auto ascale = head_number(gcsv, "ascale");  // to g
  const bool accelerates = ascale && std::ranges::all_of(table.rows, [](const CsvRow& row) {
                             return std::ranges::count(row.text, ',') >= 6;
                           });
  Gyroscope gyroscope;
  gyroscope.file = file;
  gyroscope.left_out = drop_unmeasured(table, 1, 3);
  AccelerationSamples forces;
  for (const CsvRow& row : table.rows) {
    const double time_s = tscale * csv_number(table, row, 0);
    if (!(std::abs(time_s) < kMostTime_s))
      csv_fail(table, row.line, "an implausible time", "seconds");
    add_sample(
        gyroscope, table, row, std::llround(1e9 * time_s), gscale * csv_vector(table, row, 1));
    if (!accelerates || !is_measured(table, row, 4, 3)) continue;
    forces.timestamps_ns.push_back(gyroscope.timestamps_ns.back());
    forces.specific_force.emplace_back(kStandardGravity_m_s2 * *ascale * csv_vector(table, row, 4));
  }
  add_accelerations(forces, gyroscope);
  log.gyroscope = std::move(gyroscope);
  if (const auto readout_ms = head_number(gcsv, "frame_readout_time")) {
    // 0: top to bottom, 1: bottom to top, 2: left to right, 3: right to left.
    const double direction = head_number(gcsv, "frame_readout_direction").value_or(0);
    log.readout_s = (direction == 1 ? -1e-3 : 1e-3) * *readout_ms;
    if (direction == 2) log.readout_direction = ReadoutDirection::right;
    if (direction == 3) log.readout_direction = ReadoutDirection::left;
  }
  return log;
}

}  // namespace gpo
