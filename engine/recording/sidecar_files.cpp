// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/sidecar_files.h"

#include "engine/recording/yaml_entry.h"

#include <cmath>

namespace gpo {

namespace {

int corner_count(const YamlEntry& root, const std::string& key) {
  const std::string expected = "a number of inner corners, 3 to 100";
  const auto entry = at(root, key, expected);
  const std::int64_t count = integer(entry, expected);
  if (count < 3 || count > 100) yaml_fail(entry, std::to_string(count), expected);
  return static_cast<int>(count);
}

}  // namespace

Board read_board(const std::filesystem::path& file) {
  const auto root = load_yaml(file);
  const auto pattern = at(root, "pattern", "chessboard");
  if (text(pattern, "chessboard") != "chessboard") yaml_fail(pattern, "chessboard");
  const auto square = at(root, "square", "the side of a square in meters");
  const Board board{corner_count(root, "columns"), corner_count(root, "rows"), number(square)};
  if (board.square_m <= 0) {
    yaml_fail(square, text(square, ""), "the side of a square in meters, > 0");
  }
  return board;
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

}  // namespace gpo
