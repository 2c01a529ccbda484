// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/companion_files.h"

#include "engine/base/limits.h"
#include "engine/files/text_file.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

double rad_s_per_unit(const CsvTable& table) {
  if (table.header.empty()) return 1;
  const std::string name = lower_case(table.header[1]);
  const bool degrees =
      name.find("deg") != std::string::npos || name.find("dps") != std::string::npos;
  return degrees ? std::numbers::pi / 180 : 1;
}

constexpr int kBiasColumn = 11;  // columns: t, p (3), q (4), v (3), b_w (3), b_a (3)
constexpr int kColumnsWithBias = 17;
constexpr double kMostSeconds = 1e6;

PosePath path_of(CsvTable table, TimeUnit unit, const std::array<int, 4>& quaternion) {
  PosePath path;
  path.left_out = drop_repeats(table) + drop_unmeasured(table, 1, 7);
  path.timestamps_ns = csv_time_stamps(table, unit);
  path.longest_gap_ns = usual_longest_gap_ns(path.timestamps_ns);
  for (const auto& row : table.rows) path.poses.push_back(csv_pose(table, row, 1, quaternion));
  return path;
}

std::optional<Eigen::Vector3d> mean_bias(const CsvTable& table) {
  if (table.columns != kColumnsWithBias) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto& row : table.rows) {
    if (!is_measured(table, row, kBiasColumn, 3)) continue;
    sum += csv_vector(table, row, kBiasColumn);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::optional<std::int64_t> nanoseconds(const YamlEntry& root, const std::string& key) {
  const auto entry = find(root, key);
  if (!entry) return std::nullopt;
  const double seconds = number(*entry);
  if (std::abs(seconds) > kMostSeconds) yaml_fail(*entry, "seconds, at most 1e6");
  return std::llround(seconds * 1e9);
}

}  // namespace

Pose csv_pose(const CsvTable& table,
              const CsvRow& row,
              int position,
              const std::array<int, 4>& quaternion) {
  std::array<double, 7> v{};
  for (int k = 0; k < 7; ++k)
    v[k] = csv_number(table, row, k < 4 ? quaternion[k] : position + k - 4);
  const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
  if (!(std::abs(q.norm() - 1) <= 1e-2))
    csv_fail(
        table, row.line, fmt::format("a quaternion of norm {:g}", q.norm()), "a unit quaternion");
  return {q.normalized().toRotationMatrix(), {v[4], v[5], v[6]}};
}

Gyroscope read_gyroscope(const fs::path& file, TimeUnit unit) {
  CsvTable table = read_csv(file, {"timestamp", "wx", "wy", "wz"}, CsvColumns::at_least);
  const int repeats = drop_repeats(table);
  const auto times_ns = csv_time_stamps(table, unit);
  const double scale = rad_s_per_unit(table);
  const bool accelerations =
      table.columns >= 7 && (table.header.empty() || lower_case(table.header[4])[0] == 'a');
  Gyroscope gyroscope;
  gyroscope.file = file;
  AccelerationSamples forces;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    const CsvRow& row = table.rows[i];
    if (is_measured(table, row, 1, 3)) {
      gyroscope.timestamps_ns.push_back(times_ns[i]);
      gyroscope.lines.push_back(row.line);
      gyroscope.rates_rad_s.emplace_back(scale * csv_vector(table, row, 1));
    }
    if (accelerations && is_measured(table, row, 4, 3)) {
      forces.timestamps_ns.push_back(times_ns[i]);
      forces.specific_force.push_back(csv_vector(table, row, 4));
    }
  }
  gyroscope.left_out = repeats + static_cast<int>(times_ns.size() - gyroscope.rates_rad_s.size());
  if (gyroscope.rates_rad_s.empty())
    csv_fail(table, table.rows.front().line, "no row of finite rates", "some");
  add_accelerations(forces, gyroscope);
  return gyroscope;
}

void add_accelerations(const AccelerationSamples& samples, Gyroscope& gyroscope) {
  constexpr std::int64_t kLongestGap_ns = 100'000'000;
  const auto& [times, values] = samples;
  if (times.size() != values.size() || times.empty() || gyroscope.timestamps_ns.empty()) return;
  if (times == gyroscope.timestamps_ns) {
    gyroscope.accelerations_m_s2 = values;
    return;
  }
  const bool covers = times.front() <= gyroscope.timestamps_ns.front() + kLongestGap_ns &&
                      times.back() >= gyroscope.timestamps_ns.back() - kLongestGap_ns;
  if (!covers || times.size() < 2 || !std::ranges::is_sorted(times, std::less_equal())) return;
  Gyroscope as_rates;
  as_rates.timestamps_ns = times;
  as_rates.rates_rad_s = values;
  for (const std::int64_t time_ns : gyroscope.timestamps_ns) {
    const auto after = std::ranges::lower_bound(times, time_ns);
    const bool in_gap = after != times.begin() && after != times.end() &&
                        *after - *std::prev(after) > kLongestGap_ns && *after != time_ns;
    gyroscope.accelerations_m_s2.push_back(
        in_gap ? Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())
               : sample_at(as_rates, time_ns).rate_rad_s);
  }
}

ImuCalibration read_imu_calibration(const fs::path& file) {
  ImuCalibration result;
  const auto root = load_yaml(file);
  if (const auto T_BS = find(root, "T_BS")) result.R_body_gyro = rigid_motion(*T_BS).R_wc;
  if (const auto bias = find(root, "gyroscope_bias")) {
    const auto b = numbers(*bias, 3, "3 (x, y, z) in rad/s");
    result.bias_rad_s = Eigen::Vector3d(b[0], b[1], b[2]);
  }
  if (const auto sigma = find(root, "gyroscope_bias_sigma")) {
    const std::string expected = "a positive number in rad/s";
    result.bias_sigma_rad_s = number(*sigma, expected);
    if (!Limit{"", *result.bias_sigma_rad_s, kAboveZero}.holds()) yaml_fail(*sigma, expected);
  }
  if (const auto density = find(root, "gyroscope_noise_density")) {
    const std::string expected = "a number >= 0 in rad/s/sqrt(Hz)";
    const double value = number(*density, expected);
    if (!Limit{"", value, kFromZero}.holds()) yaml_fail(*density, expected);
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

PosePath read_euroc_path(const fs::path& file) {
  const CsvTable table =
      read_csv(file, {"timestamp", "px", "py", "pz", "qw", "qx", "qy", "qz"}, CsvColumns::at_least);
  PosePath path = path_of(table, TimeUnit::nanoseconds, {4, 5, 6, 7});
  path.mean_gyro_bias_rad_s = mean_bias(table);
  return path;
}

PosePath read_tum_path(const fs::path& file) {
  const CsvTable table = read_csv(file,
                                  {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"},
                                  CsvColumns::exactly,
                                  Separator::blanks);
  return path_of(table, TimeUnit::seconds, {7, 4, 5, 6});
}

std::optional<Pose> pose_at(const PosePath& path, std::int64_t time_ns) {
  constexpr std::int64_t kMostOutside_ns = 1'000'000;
  constexpr std::int64_t kPeriodsPerOutside = 10;
  const auto& times = path.timestamps_ns;
  const auto after = std::ranges::lower_bound(times, time_ns);
  if (after != times.end() && *after == time_ns) return path.poses[after - times.begin()];
  if (times.size() < 2) return std::nullopt;
  const auto b = std::clamp<std::ptrdiff_t>(after - times.begin(), 1, std::ssize(times) - 1);
  const auto a = b - 1;
  const std::int64_t period_ns = times[b] - times[a];
  if (period_ns > path.longest_gap_ns) return std::nullopt;
  // The ends of rounded times: extrapolates a little.
  const std::int64_t outside_ns = std::min(kMostOutside_ns, period_ns / kPeriodsPerOutside);
  if (time_ns < times[a] - outside_ns || time_ns > times[b] + outside_ns) return std::nullopt;
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
  truth.source = mounting.source.empty()
                     ? std::move(source)
                     : fmt::format("{}{}{}", source, kOriginally, mounting.source);
  truth.upright = mounting.upright.value_or(false);
  truth.left_out = path.left_out;
  truth.R_measured_camera = mounting.T_measured_camera.R_wc;
  for (const std::int64_t time : frame_times_ns) {
    const auto measured = pose_at(path, time + mounting.time_offset_ns);
    truth.poses.push_back(measured ? std::optional(*measured * mounting.T_measured_camera)
                                   : std::nullopt);
  }
  std::vector<std::int64_t> times = path.timestamps_ns;
  for (std::int64_t& time : times) time -= mounting.time_offset_ns;
  truth.jumps =
      jumps_of(times, std::vector<std::optional<Pose>>(path.poses.begin(), path.poses.end()));
  keep_between(frame_times_ns.front(), frame_times_ns.back(), truth.jumps);
  return truth;
}

void read_truth_clock(const fs::path& yaml, PosePath& path, TruthMounting& mounting) {
  const YamlEntry root = load_yaml(yaml);
  if (const auto offset = nanoseconds(root, "time_offset_s")) mounting.time_offset_ns = *offset;
  if (const auto gap = nanoseconds(root, "longest_gap_s")) path.longest_gap_ns = *gap;
  if (const auto upright = find(root, "upright")) {
    const std::string value = text(*upright, "true or false");
    if (value != "true" && value != "false") yaml_fail(*upright, "true or false");
    mounting.upright = value == "true";
  }
  if (const auto source = find(root, "source")) mounting.source = text(*source, "a name");
}

void read_mounting_beside(const fs::path& folder, PosePath& path, TruthMounting& mounting) {
  const auto yaml = if_file(folder / "groundtruth.yaml");
  if (!yaml) return;
  read_truth_clock(*yaml, path, mounting);
  if (const auto T = find(load_yaml(*yaml), "T_truth_camera"))
    mounting.T_measured_camera = rigid_motion(*T);
}

std::optional<GroundTruth> truth_beside(const fs::path& folder,
                                        const std::vector<std::int64_t>& frame_times_ns) {
  const auto file = if_file(folder / "groundtruth.txt");
  if (!file) return std::nullopt;
  PosePath path = read_tum_path(*file);
  TruthMounting mounting;
  read_mounting_beside(folder, path, mounting);
  return camera_truth(path, mounting, file->filename().string(), frame_times_ns);
}

Plane read_plane(const fs::path& file) {
  const auto root = load_yaml(file);
  const auto normal = at(root, "normal", "[x, y, z]");
  const auto n = numbers(normal, 3, "3 (x, y, z)");
  const double distance = number(at(root, "distance", "a number of meters"));
  const double norm = std::hypot(n[0], n[1], n[2]);
  if (std::abs(norm - 1) > 1e-2)
    yaml_fail(normal, "length " + std::to_string(norm), "a unit vector");
  return {Eigen::Vector3d(n[0], n[1], n[2]) / norm, distance / norm};
}

std::map<std::string, std::string> sidecar_texts(const Recording& recording) {
  std::map<std::string, std::string> files;
  if (const auto& plane = recording.plane)
    files["plane.yaml"] =
        fmt::format("# In the world of the ground truth, meters.\nnormal: [{}]\ndistance: {}\n",
                    fmt::join(plane->normal, ", "),
                    plane->distance);
  if (recording.board) files["board.yaml"] = board_yaml(*recording.board);
  if (recording.tracks.empty()) return files;
  std::string& text = files["tracks.csv"];
  const bool weighted = recording.tracks.front().sigma_px > 0;
  text = weighted ? "frame,track,x,y,sigma_px\n" : "frame,track,x,y\n";
  for (const TrackObservation& o : recording.tracks) {
    text += fmt::format("{},{},{},{}", o.frame, o.track, o.raw_px.x(), o.raw_px.y());
    text += weighted ? fmt::format(",{}\n", o.sigma_px) : "\n";
  }
  return files;
}

}  // namespace gpo
