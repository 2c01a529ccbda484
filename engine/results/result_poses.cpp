// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_poses.h"

#include "engine/base/error.h"
#include "engine/files/csv_table.h"
#include "engine/files/folder.h"
#include "engine/files/text_file.h"
#include "engine/geometry/nearest_rotation.h"
#include "engine/recording/companions/truth_file.h"
#include "engine/results/colmap_model.h"
#include "engine/results/ply_points.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// The first line that is neither empty nor a remark nor the names of columns.
std::string_view first_row(std::string_view text) {
  TextLines lines(text);
  while (const auto line = lines.next()) {
    if (line->empty() || line->front() == '#') continue;
    if (parse_decimal(line->substr(0, line->find_first_of(", \t")), 0)) return *line;
  }
  return {};
}

std::string_view last_row(std::string_view text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string_view::npos) return {};
  const std::size_t before = text.rfind('\n', end);
  return trimmed(text.substr(before == std::string_view::npos ? 0 : before + 1));
}

std::size_t words_in(std::string_view line) {
  std::size_t count = 0;
  for (; !line.empty(); ++count) take_word(line);
  return count;
}

std::optional<double> time_in(std::string_view row) {
  return parse_number(row.substr(0, row.find_first_of(", \t")));
}

/// Frames are not hours apart, and not less than ten microseconds; a single one is told by its
/// size: seconds since 1970 have ten digits until 2286.
TimeUnit unit_of(std::string_view text) {
  constexpr double kLargestStep_s = 1e4;
  constexpr double kMostSeconds = 1e10;
  const auto first = time_in(first_row(text));
  const auto last = time_in(last_row(text));
  if (!first || !last) return TimeUnit::seconds;
  const auto lines = static_cast<double>(1 + std::ranges::count(text, '\n'));
  const bool ns = *last > kMostSeconds || *last - *first > kLargestStep_s * lines;
  return ns ? TimeUnit::nanoseconds : TimeUnit::seconds;
}

ResultPoses by_time(std::string layout, PosedFrame frame, PosePath path) {
  ResultPoses result;
  result.layout = std::move(layout);
  result.frame = frame;
  result.timestamps_ns = std::move(path.timestamps_ns);
  result.poses = std::move(path.poses);
  return result;
}

/// Camera poses are what TUM's benchmark compares, and what ORB-SLAM3 writes without an IMU.
ResultPoses read_tum(const fs::path& file, std::string_view text) {
  const TimeUnit unit = unit_of(text);
  return by_time(unit == TimeUnit::seconds ? "TUM" : "TUM with nanoseconds",
                 PosedFrame::camera,
                 read_tum_path(file, unit));
}

/// EuRoC's poses are the body's; ours say in the first line that they are not.
ResultPoses read_euroc(const fs::path& file, std::string_view text) {
  const std::string_view head = text.substr(0, text.find('\n'));
  const bool of_camera =
      head.starts_with('#') && head.find("camera to world") != std::string_view::npos;
  return by_time("EuRoC", of_camera ? PosedFrame::camera : PosedFrame::body, read_euroc_path(file));
}

ResultPoses read_kitti(const fs::path& file) {
  constexpr double kMostSkew = 1e-2;  // written with few digits
  const CsvTable table =
      read_csv(file,
               {"r11", "r12", "r13", "tx", "r21", "r22", "r23", "ty", "r31", "r32", "r33", "tz"},
               CsvColumns::exactly,
               Separator::blanks);
  ResultPoses result;
  result.layout = "KITTI";
  result.by = FoundBy::number;
  result.poses.reserve(table.rows.size());
  for (const CsvRow& row : table.rows) {
    Eigen::Matrix<double, 3, 4> T;
    for (int i = 0; i < 12; ++i) T(i / 4, i % 4) = csv_number(table, row, i);
    const auto R = rotation_meant(T.leftCols<3>(), kMostSkew);
    if (!R) csv_fail(table, row.line, "no rotation", "[R t], row by row");
    result.poses.push_back({*R, T.col(3)});
  }
  return result;
}

ResultPoses of_images(std::vector<ColmapImage> images) {
  ResultPoses result;
  result.layout = "COLMAP";
  result.by = FoundBy::name;
  for (ColmapImage& image : images) {
    result.names.push_back(std::move(image.name));
    result.poses.push_back(image.camera);
  }
  return result;
}

void check_size(const fs::path& path, const ResultPoses& result) {
  for (std::size_t i = 0; i < result.poses.size(); ++i) {
    if (result.poses[i].p_wc.cwiseAbs().maxCoeff() <= kLargestCoordinate) continue;
    throw InputError(fmt::format(
        "{}: pose {}: found a position beyond {:g}", path.string(), i + 1, kLargestCoordinate));
  }
}

/// The file of a model's folder, binary before text as in COLMAP.
std::optional<fs::path> part_of_model(const fs::path& folder, const std::string& name) {
  const auto binary = if_file(folder / (name + ".bin"));
  return binary ? binary : if_file(folder / (name + ".txt"));
}

fs::path model_file(const fs::path& path, const std::string& name) {
  if (!is_folder(path)) return path;
  const auto part = part_of_model(path, name);
  if (part) return *part;
  throw InputError(fmt::format(
      "{}: found neither {}.bin nor {}.txt, expected a model of COLMAP, e.g. its sparse/0",
      path.string(),
      name,
      name));
}

bool is_colmaps(const fs::path& file, std::string_view text) {
  const std::string name = file.filename().string();
  return name == "images.bin" || name == "images.txt" || text.starts_with("# Image list with two");
}

ResultPoses read_poses(const fs::path& path) {
  const fs::path file = model_file(path, "images");
  const std::string text = read_file(file);
  if (is_colmaps(file, text)) return of_images(read_colmap_images(file, text));
  const std::string_view row = first_row(text);
  if (row.find(',') != std::string_view::npos) return read_euroc(file, text);
  const std::size_t words = words_in(row);
  if (words == 12) return read_kitti(file);
  if (words == 8) return read_tum(file, text);
  throw InputError(fmt::format(
      "{}: found {}, expected a trajectory of TUM, EuRoC or KITTI (8 numbers with blanks or "
      "commas, or 12 with blanks) or COLMAP's images.txt",
      file.string(),
      row.empty() ? "no row of numbers" : fmt::format("rows of {} numbers", words)));
}

}  // namespace

ResultPoses read_result_poses(const fs::path& path) {
  ResultPoses result = read_poses(path);
  check_size(path, result);
  return result;
}

bool has_points(const fs::path& folder) { return part_of_model(folder, "points3D").has_value(); }

Eigen::Matrix3Xd read_result_points(const fs::path& path) {
  const fs::path file = model_file(path, "points3D");
  const std::string bytes = read_file(file);
  if (bytes.starts_with("ply")) return read_ply_points(file, bytes);
  const std::string name = file.filename().string();
  if (name == "points3D.bin" || name == "points3D.txt" ||
      bytes.starts_with("# 3D point list with one"))
    return read_colmap_points(file, bytes);
  throw InputError(file.string() + ": found neither PLY nor COLMAP's points3D.txt or points3D.bin");
}

}  // namespace gpo
