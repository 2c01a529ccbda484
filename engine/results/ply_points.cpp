// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/ply_points.h"

#include "engine/base/error.h"
#include "engine/files/byte_cursor.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// A kind of number as headers name it, and how it is read.
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
  std::vector<const Kind*> properties;  ///< of a vertex
  std::array<int, 3> xyz{-1, -1, -1};   ///< which of them
  std::size_t vertex_bytes = 0;
};

/// Walks through the lines of a file, of which the rest may be binary.
class HeaderLines {
 public:
  HeaderLines(const fs::path& file, std::string_view bytes) : file_(file), lines_(bytes) {}

  bool more() const { return !rest().empty(); }
  std::vector<std::string> words() {
    constexpr std::size_t kLongest = 4096;
    std::string_view line = lines_.next().value_or("");
    if (line.size() > kLongest)
      fail(fmt::format("a line of {} bytes", line.size()), "a shorter one");
    std::vector<std::string> words;
    while (!line.empty()) words.emplace_back(take_word(line));
    return words;
  }
  std::string_view rest() const { return lines_.rest(); }
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(fmt::format(
        "{}:{}: found {}, expected {}", file_.string(), lines_.number(), found, expected));
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

/// What follows the vertices need not be read.
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
      if (header.vertices >= 0 && words[1] == "vertex") lines.fail("vertices again", "them once");
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
    lines.fail("no vertices with x, y and z", "some");
  header.ascii = format == "ascii";
  return header;
}

/// Fewer than the header says would be told only after all had been kept.
void check_count(const HeaderLines& lines, const Header& header) {
  const std::size_t least = header.ascii ? 2 * header.properties.size() - 1 : header.vertex_bytes;
  const std::size_t last_end = header.ascii ? 1 : 0;  // the last line may have none
  const auto most = static_cast<std::int64_t>((lines.rest().size() + last_end) / least);
  if (header.vertices > most)
    lines.fail(fmt::format("{} vertices in {} bytes", header.vertices, lines.rest().size()),
               "as many as there are");
}

void check_point(const Eigen::Vector3d& point, std::int64_t number, const fs::path& file) {
  if (point.allFinite() && point.cwiseAbs().maxCoeff() <= kLargestCoordinate) return;
  throw InputError(fmt::format("{}: vertex {}: found ({:g} {:g} {:g}), expected numbers up to {:g}",
                               file.string(),
                               number + 1,
                               point.x(),
                               point.y(),
                               point.z(),
                               kLargestCoordinate));
}

Eigen::Vector3d ascii_vertex(HeaderLines& lines, const Header& header) {
  const auto words = lines.words();
  if (words.size() != header.properties.size())
    lines.fail(fmt::format("{} numbers", words.size()),
               fmt::format("{}, the vertex' properties", header.properties.size()));
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
