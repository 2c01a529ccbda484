// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/companion_files.h"

#include "engine/base/limits.h"
#include "engine/files/text_file.h"
#include "engine/recording/board/board.h"
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
constexpr const char* kCorners = "a number of inner corners";
constexpr const char* kTags = "a number of tags";

PosePath path_of(const CsvTable& table, TimeUnit unit, const std::array<int, 4>& quaternion) {
  PosePath path;
  path.timestamps_ns = csv_time_stamps(table, unit);
  path.longest_gap_ns = usual_longest_gap_ns(path.timestamps_ns);
  for (const auto& row : table.rows) path.poses.push_back(csv_pose(table, row, 1, quaternion));
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

int whole_number(const YamlEntry& entry, int least, int most, const std::string& meaning) {
  const std::string expected = fmt::format("{}, {} to {}", meaning, least, most);
  const std::int64_t number = integer(entry, expected);
  if (number < least || number > most) yaml_fail(entry, expected);
  return static_cast<int>(number);
}

int corner_count(const YamlEntry& root, const std::string& key) {
  return whole_number(at(root, key, kCorners), 3, 100, kCorners);
}

int tag_count(const YamlEntry& root, const std::string& key) {
  return whole_number(at(root, key, kTags), 1, 50, kTags);
}

double length_m(const YamlEntry& root, const std::string& key, const std::string& expected) {
  const auto entry = at(root, key, expected);
  const double length = number(entry, expected);
  if (length <= 0) yaml_fail(entry, text(entry, ""), fmt::format("{}, > 0", expected));
  return length;
}

double square_side(const YamlEntry& root) {
  return length_m(root, "square", "the side of a square in meters");
}

Board chessboard(const YamlEntry& root) {
  return {corner_count(root, "columns"), corner_count(root, "rows"), square_side(root)};
}

/// `squares` is the number of squares, as in OpenCV's CharucoBoard.
Board charuco_board(const YamlEntry& root) {
  const std::string expected = "2 counts of squares (x, y), 3 to 100 each";
  const auto squares = at(root, "squares", expected);
  const auto counts = numbers(squares, 2, expected);
  for (const double count : counts)
    if (count < 3 || count > 100 || count != std::floor(count))
      yaml_fail(squares, fmt::format("{:g}", count), expected);
  Board board{static_cast<int>(counts[0]) - 1, static_cast<int>(counts[1]) - 1, square_side(root)};
  const double marker = length_m(root, "marker", "the side of a marker in meters");
  if (marker >= board.square_m)
    yaml_fail(at(root, "marker", ""),
              fmt::format("{:g}", marker),
              fmt::format("less than the square's side, {:g}", board.square_m));
  const auto dictionary = at(root, "dictionary", "one of " + dictionary_names());
  const auto name = dictionary_name(text(dictionary, "a name"));
  if (!name) yaml_fail(dictionary, "one of " + dictionary_names());
  board.markers = BoardMarkers{marker, *name};
  if (marker_count(board) > dictionary_size(*name))
    yaml_fail(dictionary,
              fmt::format("{} with {} markers", *name, dictionary_size(*name)),
              fmt::format("at least {}, one for each marker of the board", marker_count(board)));
  return board;
}

/// Reads the width of a tag's black border; Kalibr's is twice as wide as others.
int tag_border(const YamlEntry& root, int otherwise) {
  const auto entry = find(root, "tagBorder");
  return entry ? whole_number(*entry, 1, 2, "a number of bits") : otherwise;
}

Board april_grid(const YamlEntry& root) {
  Board board{2 * tag_count(root, "tagCols"), 2 * tag_count(root, "tagRows"), 0};
  board.square_m = length_m(root, "tagSize", "the side of a tag in meters");
  const auto spacing = at(root, "tagSpacing", "the gap between tags divided by their side");
  const double ratio = number(spacing);
  if (ratio <= 0 || ratio > 1)
    yaml_fail(
        spacing, fmt::format("{:g}", ratio), "the gap between tags divided by their side, 0 to 1");
  board.tags = BoardTags{ratio, tag_border(root, 2), {}};
  const int count = board.columns * board.rows / 4;
  if (count > april_tag_count())
    yaml_fail(at(root, "tagCols", ""),
              fmt::format("{} tags", count),
              fmt::format("at most {}", april_tag_count()));
  return board;
}

Board april_tag(const YamlEntry& root) {
  Board board{2, 2, length_m(root, "tagSize", "the side of the tag in meters")};
  const auto id = find(root, "id");
  const int number =
      id ? whole_number(*id, 0, april_tag_count() - 1, "a tag's number") : BoardTags::kAnyTag;
  board.tags = BoardTags{0, tag_border(root, 1), number};
  return board;
}

using Pattern = std::pair<const char*, Board (*)(const YamlEntry& root)>;
constexpr std::array<Pattern, 4> kPatterns = {{{"chessboard", chessboard},
                                               {"charuco", charuco_board},
                                               {"aprilgrid", april_grid},
                                               {"apriltag", april_tag}}};
constexpr const char* kPatternNames = "chessboard, charuco, aprilgrid or apriltag";

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
  const CsvTable table = read_csv(file, {"timestamp", "wx", "wy", "wz"}, CsvColumns::at_least);
  Gyroscope gyroscope;
  gyroscope.file = file;
  gyroscope.timestamps_ns = csv_time_stamps(table, unit);
  const double scale = rad_s_per_unit(table);
  const bool accelerations =
      table.columns >= 7 && (table.header.empty() || lower_case(table.header[4])[0] == 'a');
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

PosePath read_tum_path(const fs::path& file, TimeUnit unit) {
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
  truth.source = mounting.source.empty()
                     ? std::move(source)
                     : fmt::format("{}{}{}", source, kOriginally, mounting.source);
  truth.upright = mounting.upright.value_or(false);
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

Board read_board(const fs::path& file) {
  const auto root = load_yaml(file);
  const auto kalibr = find(root, "target_type");
  const auto pattern = kalibr ? *kalibr : at(root, "pattern", kPatternNames);
  const std::string name = text(pattern, kPatternNames);
  const auto known = std::ranges::find(kPatterns, name, &Pattern::first);
  if (known == kPatterns.end()) yaml_fail(pattern, kPatternNames);
  return known->second(root);
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

std::string board_yaml(const Board& board) {
  const int columns = board.columns, rows = board.rows;
  const double side = board.square_m;
  if (board.tags && board.tags->alone) {
    const int id = *board.tags->alone;
    return fmt::format("# Meters.\npattern: apriltag\ntagSize: {}\ntagBorder: {}\n{}",
                       side,
                       board.tags->border,
                       id == BoardTags::kAnyTag ? "" : fmt::format("id: {}\n", id));
  }
  if (board.tags)
    return fmt::format(
        "# Kalibr's keys, meters.\npattern: aprilgrid\ntagCols: {}\ntagRows: {}\ntagSize: {}\n"
        "tagSpacing: {}\ntagBorder: {}\n",
        columns / 2,
        rows / 2,
        side,
        board.tags->spacing,
        board.tags->border);
  const auto& markers = board.markers;
  if (!markers)
    return fmt::format(
        "# Inner corners, meters.\npattern: chessboard\ncolumns: {}\nrows: {}\nsquare: {}\n",
        columns,
        rows,
        side);
  return fmt::format(
      "# Squares along x and y; meters.\npattern: charuco\nsquares: [{}, {}]\nsquare: {}\n"
      "marker: {}\ndictionary: {}\n",
      columns + 1,
      rows + 1,
      side,
      markers->side_m,
      markers->dictionary);
}

std::string plane_yaml(const Plane& plane) {
  return fmt::format("# In the world of the ground truth, meters.\nnormal: [{}]\ndistance: {}\n",
                     fmt::join(plane.normal, ", "),
                     plane.distance);
}

std::map<std::string, std::string> sidecar_texts(const Recording& recording) {
  std::map<std::string, std::string> files;
  if (recording.plane) files["plane.yaml"] = plane_yaml(*recording.plane);
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
