// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_poses.h"

#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/geometry/decompositions.h"
#include "engine/recording/companions/colmap_model.h"
#include "engine/recording/companions/companion_files.h"

#include <algorithm>

namespace gpo {
namespace {

std::string_view first_row(std::string_view text) {
  TextLines lines(text);
  while (const auto line = lines.next()) {
    if (line->empty() || line->front() == '#') continue;
    if (parse_decimal(line->substr(0, line->find_first_of(", \t")), 0)) return *line;
  }
  return {};
}

std::optional<double> time_in(std::string_view row) {
  return parse_number(row.substr(0, row.find_first_of(", \t")));
}

/// Assumes that frames are 10 us to hours apart; a single time by its size.
TimeUnit unit_of(std::string_view text) {
  constexpr double kMaxStep_s = 1e4;
  constexpr double kMaxSeconds = 1e10;
  const std::string_view rows = trimmed(text);
  const auto first = time_in(first_row(text));
  const auto last = time_in(trimmed(rows.substr(rows.rfind('\n') + 1)));  // npos + 1 is 0
  if (!first || !last) return TimeUnit::seconds;
  const auto lines = static_cast<double>(1 + std::ranges::count(text, '\n'));
  const bool ns = *last > kMaxSeconds || *last - *first > kMaxStep_s * lines;
  return ns ? TimeUnit::nanoseconds : TimeUnit::seconds;
}

ResultPoses by_time(CsvTable table, TimeUnit unit, const std::array<int, 4>& quaternion) {
  ResultPoses result;
  result.repeats = drop_repeats(table);
  result.unmeasured = drop_unmeasured(table, 1, 7);
  result.timestamps_ns = csv_time_stamps(table, unit);
  for (const CsvRow& row : table.rows) result.poses.push_back(csv_pose(table, row, 1, quaternion));
  return result;
}

const std::vector<std::string> kTumColumns = {
    "timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
const std::vector<std::string> kEurocColumns = {
    "timestamp", "px", "py", "pz", "qw", "qx", "qy", "qz"};
constexpr std::array kScalarLast{7, 4, 5, 6}, kScalarFirst{4, 5, 6, 7};

/// TUM's benchmark compares camera poses, and ORB-SLAM3 without an IMU writes them.
ResultPoses read_tum(const fs::path& file, std::string_view text) {
  const TimeUnit unit = unit_of(text);
  ResultPoses result = by_time(
      read_csv(file, kTumColumns, CsvColumns::exactly, Separator::blanks), unit, kScalarLast);
  result.layout = unit == TimeUnit::seconds ? "TUM" : "TUM with nanoseconds";
  return result;
}

/// EuRoC has body poses, except for our camera poses, which the first line declares. Rows in
/// seconds are TUM's with commas, unless the first line names the scalar first.
ResultPoses read_commas(const fs::path& file, std::string_view text) {
  const std::string head = lower_case(text.substr(0, text.find('\n')));
  const bool of_camera = head.starts_with('#') && head.find("camera to world") != std::string::npos;
  const bool scalar_is_named_first =
      head.find("qw") < head.find("qx") || head.find("q_w") < head.find("q_x");
  const bool tum = unit_of(text) == TimeUnit::seconds && !scalar_is_named_first;
  ResultPoses result =
      tum ? by_time(
                read_csv(file, kTumColumns, CsvColumns::at_least), TimeUnit::seconds, kScalarLast)
          : by_time(
                read_csv(file, kEurocColumns, CsvColumns::at_least), unit_of(text), kScalarFirst);
  result.layout = tum ? "TUM with commas" : "EuRoC";
  result.frame = tum || of_camera ? PosedFrame::camera : PosedFrame::body;
  return result;
}

ResultPoses read_kitti(const fs::path& file) {
  constexpr double kMaxSkew = 1e-2;  // few digits
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
    const auto R = rotation_meant(T.leftCols<3>(), kMaxSkew);
    if (!R) csv_fail(table, row.line, "a matrix that is not a rotation", "[R t], row by row");
    result.poses.push_back({*R, T.col(3)});
  }
  return result;
}

std::optional<fs::path> part_of_model(const fs::path& folder, const std::string& name) {
  const auto binary = if_file(folder / (name + ".bin"));
  return binary ? binary : if_file(folder / (name + ".txt"));
}

fs::path model_file(const fs::path& path, const std::string& name) {
  if (!is_folder(path)) return path;
  if (const auto part = part_of_model(path, name)) return *part;
  refuse(path, "found neither {0}.bin nor {0}.txt, expected a COLMAP model, e.g. sparse/0", name);
}

ResultPoses read_poses(const fs::path& path) {
  const fs::path file = model_file(path, "images");
  const std::string text = read_file(file);
  const std::string name = file.filename().string();
  if (name == "images.bin" || name == "images.txt" || text.starts_with("# Image list with two"))
    return read_colmap_images(file, text);
  const std::string_view row = first_row(text);
  if (row.find(',') != std::string_view::npos) return read_commas(file, text);
  std::size_t words = 0;
  for (std::string_view rest = row; !rest.empty(); ++words) take_word(rest);
  if (words == 12) return read_kitti(file);
  if (words == 8) return read_tum(file, text);
  fail_at(
      file,
      row.empty() ? "no row of numbers" : "rows of " + counted(words, "number"),
      "a TUM, EuRoC or KITTI trajectory (8 numbers with blanks or commas, or 12 with blanks) or "
      "COLMAP's images.txt");
}

struct Kind {
  const char* name;
  const char* other_name;
  std::size_t bytes;
  double (*read)(ByteCursor& cursor);
};

template <class T>
double read_as(ByteCursor& cursor) {
  return static_cast<double>(cursor.number<T>());
}

constexpr std::array<Kind, 8> kKinds{{{"char", "int8", 1, read_as<std::int8_t>},
                                      {"uchar", "uint8", 1, read_as<std::uint8_t>},
                                      {"short", "int16", 2, read_as<std::int16_t>},
                                      {"ushort", "uint16", 2, read_as<std::uint16_t>},
                                      {"int", "int32", 4, read_as<std::int32_t>},
                                      {"uint", "uint32", 4, read_as<std::uint32_t>},
                                      {"float", "float32", 4, read_as<float>},
                                      {"double", "float64", 8, read_as<double>}}};

struct Header {
  bool ascii = false;
  std::int64_t vertices = -1;
  std::vector<const Kind*> properties;  ///< vertex properties
  std::array<int, 3> xyz{-1, -1, -1};   ///< their indices
  std::size_t vertex_bytes = 0;
};

class HeaderLines {
 public:
  HeaderLines(const fs::path& file, std::string_view bytes) : file_(file), lines_(bytes) {}

  bool more() const { return !rest().empty(); }
  std::vector<std::string> words() {
    constexpr std::size_t kMaxLength = 4096;
    std::string_view line = lines_.next().value_or("");
    if (line.size() > kMaxLength)
      fail(fmt::format("a line of {} bytes", line.size()), "a shorter one");
    std::vector<std::string> words;
    while (!line.empty()) words.emplace_back(take_word(line));
    return words;
  }
  std::string_view rest() const { return lines_.rest(); }
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    fail_at(place_in(file_, lines_.number()), found, expected);
  }

 private:
  const fs::path& file_;
  TextLines lines_;
};

void add_property(const std::vector<std::string>& words, const HeaderLines& lines, Header& header) {
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  if (words.size() != 3) lines.fail("a list", "vertices of single numbers");
  const auto kind = std::ranges::find_if(
      kKinds, [&](const Kind& one) { return words[1] == one.name || words[1] == one.other_name; });
  if (kind == kKinds.end())
    lines.fail(fmt::format("a property of kind {}", words[1]), "e.g. float");
  const auto axis = std::ranges::find(kNames, words[2]);
  if (axis != kNames.end()) header.xyz[axis - kNames.begin()] = std::ssize(header.properties);
  header.properties.push_back(&*kind);
  header.vertex_bytes += kind->bytes;
}

Header read_header(HeaderLines& lines) {
  Header header;
  lines.words();  // "ply"
  std::string element;
  std::string format;
  while (true) {
    if (!lines.more()) lines.fail("the end of the file", "end_header");
    const auto words = lines.words();
    const std::string key = words.empty() ? "" : words[0];
    if (key == "end_header") break;
    if (key == "format" && words.size() > 1) format = words[1];
    if (key == "element" && words.size() == 3) {
      if (header.vertices < 0 && words[1] != "vertex")
        lines.fail(fmt::format("element {}", words[1]), "the vertices first");
      if (header.vertices >= 0 && words[1] == "vertex")
        lines.fail("vertices again", "one list of vertices");
      element = words[1];
      if (element != "vertex") continue;
      const auto count = parse_integer(words[2]);
      if (!count || *count < 0) lines.fail(fmt::format("{} vertices", words[2]), "their number");
      header.vertices = *count;
    }
    if (key == "property" && element == "vertex") add_property(words, lines, header);
  }
  if (format != "ascii" && format != "binary_little_endian")
    lines.fail(fmt::format("format {}", format), "ascii or binary_little_endian");
  if (header.vertices < 0 || std::ranges::min(header.xyz) < 0)
    lines.fail("no vertices with x, y and z", "at least one");
  header.ascii = format == "ascii";
  return header;
}

void check_count(const HeaderLines& lines, const Header& header) {
  const std::size_t least = header.ascii ? 2 * header.properties.size() - 1 : header.vertex_bytes;
  const std::size_t last_end = header.ascii ? 1 : 0;  // the last line may lack its break
  const auto most = static_cast<std::int64_t>((lines.rest().size() + last_end) / least);
  if (header.vertices > most)
    lines.fail(fmt::format("{} vertices in {} bytes", header.vertices, lines.rest().size()),
               "a number that fits");
}

void check_point(const Eigen::Vector3d& point, std::int64_t number, const fs::path& file) {
  if (point.allFinite() && point.cwiseAbs().maxCoeff() <= kMaxCoordinate) return;
  refuse(file,
         "vertex {}: found ({:g}), expected numbers up to {:g}",
         number + 1,
         fmt::join(point, " "),
         kMaxCoordinate);
}

Eigen::Vector3d ascii_vertex(HeaderLines& lines, const Header& header) {
  const auto words = lines.words();
  if (words.size() != header.properties.size())
    lines.fail(fmt::format("{} numbers", words.size()),
               fmt::format("{}, the properties of a vertex", header.properties.size()));
  Eigen::Vector3d point;
  for (int k = 0; k < 3; ++k) {
    const auto value = parse_number(words[header.xyz[k]]);
    if (!value) lines.fail(fmt::format("\"{:.40}\"", words[header.xyz[k]]), "a finite number");
    point[k] = *value;
  }
  return point;
}

Eigen::Vector3d binary_vertex(ByteCursor& cursor, const Header& header) {
  Eigen::Vector3d point;
  for (int i = 0; i < std::ssize(header.properties); ++i) {
    const double value = header.properties[i]->read(cursor);
    const auto axis = std::ranges::find(header.xyz, i);
    if (axis != header.xyz.end()) point[axis - header.xyz.begin()] = value;
  }
  return point;
}

}  // namespace

ResultPoses read_colmap_images(const fs::path& file, std::string_view bytes) {
  NamedPoses images = read_colmap_poses(file, bytes);
  return {.layout = "COLMAP",
          .by = FoundBy::name,
          .timestamps_ns = {},
          .names = std::move(images.names),
          .poses = std::move(images.poses)};
}

ResultPoses read_result_poses(const fs::path& path) {
  ResultPoses result = read_poses(path);
  for (std::size_t i = 0; i < result.poses.size(); ++i)
    if (!(result.poses[i].p_wc.cwiseAbs().maxCoeff() <= kMaxCoordinate))
      refuse(path, "pose {}: found a position beyond {:g}", i + 1, kMaxCoordinate);
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
  refuse(file, "found neither PLY nor COLMAP's points3D.txt or points3D.bin");
}

Eigen::Matrix3Xd read_ply_points(const fs::path& file, std::string_view bytes) {
  HeaderLines lines(file, bytes);
  const Header header = read_header(lines);
  check_count(lines, header);
  Eigen::Matrix3Xd points(3, header.vertices);
  ByteCursor cursor(lines.rest());
  for (Eigen::Index j = 0; j < points.cols(); ++j) {
    points.col(j) = header.ascii ? ascii_vertex(lines, header) : binary_vertex(cursor, header);
    check_point(points.col(j), j, file);
  }
  return points;
}

}  // namespace gpo
