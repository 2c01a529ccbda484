// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <filesystem>
#include <map>
#include <string>

namespace gpo {

/// Reads board.yaml: {pattern: chessboard, columns: 9, rows: 6, square: 0.025}, with inner corners;
/// or {pattern: charuco, squares: [8, 6], square: 0.03, marker: 0.022, dictionary: DICT_5X5_100},
/// with squares in x and y; or Kalibr's {pattern: aprilgrid, tagCols: 6, tagRows: 6, tagSize:
/// 0.088, tagSpacing: 0.3}; or {pattern: apriltag, tagSize: 0.1, id: 0}. Throws InputError.
Board read_board(const std::filesystem::path& file);

/// Reads plane.yaml: {normal: [x, y, z], distance: d}. Throws InputError.
Plane read_plane(const std::filesystem::path& file);

// The texts of these files.
std::string board_yaml(const Board& board);
std::string plane_yaml(const Plane& plane);

/// Returns names and texts of a recording's plane.yaml, board.yaml and tracks.csv.
std::map<std::string, std::string> sidecar_texts(const Recording& recording);

}  // namespace gpo
