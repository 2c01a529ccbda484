// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// OpenCV's predefined dictionary of that name, with or without `DICT_`, in full and as OpenCV
/// spells it: "5x5_100" -> "DICT_5X5_100". Nothing where there is none.
std::optional<std::string> dictionary_name(const std::string& name);
/// "DICT_4X4_50, DICT_4X4_100, ...".
std::string dictionary_names();
/// How many markers it has; a board needs one for each of its light squares.
int dictionary_size(const std::string& dictionary);
/// Markers on a board: the light squares' count.
int marker_count(const Board& board);

/// Corners of a ChArUco board [raw px], as `find_board` gives them: those between two squares whose
/// markers are both seen, the others NaN. Empty where there is none.
///
/// OpenCV up to 4.5 began boards with an even number of rows of squares with a light square, since
/// then all begin with a dark one; both are found.
std::vector<Eigen::Vector2d> find_charuco(const cv::Mat& gray, const Board& board);

}  // namespace gpo
