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

/// Returns the board's corners in one image [raw px], sub-pixel, in the order of `board_points`:
/// row by row, so that (along a row) x (along a column) points away from the camera. Empty if there
/// is no board.
///
/// A chessboard is found completely or not at all. Its first corner is the one beside a dark inner
/// square if that distinguishes the board's rotations, otherwise the one whose rows run to the
/// right, which changes when the camera rolls (`board_symmetries`). ChArUco boards and boards of
/// tags may be partly hidden: hidden corners are NaN, and the markers determine the order.
std::vector<Eigen::Vector2d> find_board(const cv::Mat& gray, const Board& board);

/// Refines corners to sub-pixels with windows of half-size `half_px`. A corner that would move by
/// more than `reach_px` stays in place; the result is false for it.
std::vector<bool> refine_corners(std::vector<cv::Point2f>& corners,
                                 const cv::Mat& gray,
                                 int half_px,
                                 double reach_px);

/// Returns OpenCV's full name of a predefined dictionary, given with or without `DICT_`, in any
/// case: "5x5_100" -> "DICT_5X5_100". nullopt if unknown.
std::optional<std::string> dictionary_name(const std::string& name);
/// "DICT_4X4_50, DICT_4X4_100, ...".
std::string dictionary_names();
/// Number of markers in a dictionary; a board needs one for each of its light squares.
int dictionary_size(const std::string& dictionary);
/// Number of markers on a board, one in each light square.
int marker_count(const Board& board);

/// Returns the corners of a ChArUco board [raw px] as `find_board` does: those between two visible
/// markers, the others NaN. Empty if there is none.
///
/// Boards with an even number of rows of squares begin with a light square in OpenCV up to 4.5,
/// with a dark one since. Both are found.
std::vector<Eigen::Vector2d> find_charuco(const cv::Mat& gray, const Board& board);

/// Number of tags in the family 36h11.
int april_tag_count();

/// Returns the corners of a board of tags [raw px] as `find_board` does: those of visible tags, the
/// others NaN. Empty if there is none. Tags are numbered as Kalibr prints them: from the bottom row
/// up, from left to right.
std::vector<Eigen::Vector2d> find_april_tags(const cv::Mat& gray, const Board& board);

}  // namespace gpo
