// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/sidecar_files.h"

#include "engine/files/yaml_entry.h"
#include "engine/recording/board/charuco.h"

#include <cmath>

#include <fmt/format.h>

namespace gpo {

namespace {

int corner_count(const YamlEntry& root, const std::string& key) {
  const std::string expected = "a number of inner corners, 3 to 100";
  const auto entry = at(root, key, expected);
  const std::int64_t count = integer(entry, expected);
  if (count < 3 || count > 100) yaml_fail(entry, std::to_string(count), expected);
  return static_cast<int>(count);
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

/// `squares` counts the squares as OpenCV's CharucoBoard does, not the corners between them.
Board charuco_board(const YamlEntry& root) {
  const std::string expected = "2 counts of squares (x, y), 3 to 100 each";
  const auto squares = at(root, "squares", expected);
  const auto counts = numbers(squares, 2, expected);
  for (const double count : counts) {
    if (count < 3 || count > 100 || count != std::floor(count)) {
      yaml_fail(squares, fmt::format("{:g}", count), expected);
    }
  }
  Board board{static_cast<int>(counts[0]) - 1, static_cast<int>(counts[1]) - 1, square_side(root)};
  const double marker = length_m(root, "marker", "the side of a marker in meters");
  if (marker >= board.square_m) {
    yaml_fail(at(root, "marker", ""),
              fmt::format("{:g}", marker),
              fmt::format("less than the square's side, {:g}", board.square_m));
  }
  const auto dictionary = at(root, "dictionary", "one of " + dictionary_names());
  const auto name = dictionary_name(text(dictionary, "a name"));
  if (!name) yaml_fail(dictionary, "one of " + dictionary_names());
  board.markers = BoardMarkers{marker, *name};
  if (marker_count(board) > dictionary_size(*name)) {
    yaml_fail(dictionary,
              fmt::format("{} with {} markers", *name, dictionary_size(*name)),
              fmt::format("one with {}, as many as the board has", marker_count(board)));
  }
  return board;
}

}  // namespace

Board read_board(const std::filesystem::path& file) {
  const auto root = load_yaml(file);
  const auto pattern = at(root, "pattern", "chessboard or charuco");
  const std::string name = text(pattern, "chessboard or charuco");
  if (name == "chessboard") return chessboard(root);
  if (name != "charuco") yaml_fail(pattern, "chessboard or charuco");
  return charuco_board(root);
}

Plane read_plane(const std::filesystem::path& file) {
  const auto root = load_yaml(file);
  const auto normal = at(root, "normal", "[x, y, z]");
  const auto n = numbers(normal, 3, "3 (x, y, z)");
  const double distance = number(at(root, "distance", "a number of meters"));
  const double norm = std::hypot(n[0], n[1], n[2]);
  if (std::abs(norm - 1) > 1e-2) {
    yaml_fail(normal, "length " + std::to_string(norm), "a unit vector");
  }
  return {Eigen::Vector3d(n[0], n[1], n[2]) / norm, distance / norm};
}

std::string board_yaml(const Board& board) {
  if (const auto& markers = board.markers) {
    return fmt::format(
        "# Squares along x and y; meters.\npattern: charuco\nsquares: [{}, {}]\nsquare: {}\n"
        "marker: {}\ndictionary: {}\n",
        board.columns + 1,
        board.rows + 1,
        board.square_m,
        markers->side_m,
        markers->dictionary);
  }
  return fmt::format(
      "# Inner corners, meters.\npattern: chessboard\ncolumns: {}\nrows: {}\nsquare: {}\n",
      board.columns,
      board.rows,
      board.square_m);
}

std::string plane_yaml(const Plane& plane) {
  const auto& n = plane.normal;
  return fmt::format(
      "# In the world of the ground truth, meters.\nnormal: [{}, {}, {}]\ndistance: {}\n",
      n.x(),
      n.y(),
      n.z(),
      plane.distance);
}

std::map<std::string, std::string> sidecar_texts(const Recording& recording) {
  std::map<std::string, std::string> files;
  if (recording.plane) files["plane.yaml"] = plane_yaml(*recording.plane);
  if (recording.board) files["board.yaml"] = board_yaml(*recording.board);
  if (recording.tracks.empty()) return files;
  std::string& text = files["tracks.csv"];
  text = "frame,track,x,y\n";
  for (const TrackObservation& o : recording.tracks)
    text += fmt::format("{},{},{},{}\n", o.frame, o.track, o.raw_px.x(), o.raw_px.y());
  return files;
}

}  // namespace gpo
