// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// The board's corners in one picture [raw px], sub-pixel, in the order of `board_points`: row by
/// row, so that (along a row) x (along a column) points away from the camera. Empty where no board
/// is found.
///
/// A chessboard is found whole or not at all. Which end is first: the one with a dark square
/// inside, where the board's turns differ in that; else the one whose rows run to the right, which
/// is another one once the camera has rolled (`board_symmetries`). Of a ChArUco board corners may
/// be hidden, which are NaN; its markers tell the ends apart. So do the tags of a board of tags.
std::vector<Eigen::Vector2d> find_board(const cv::Mat& gray, const Board& board);

}  // namespace gpo
