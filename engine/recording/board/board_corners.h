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

/// The board's corners in one picture [raw px], sub-pixel, in the order of `board_points`: row by
/// row, so that (along a row) x (along a column) points away from the camera. Empty where no board
/// is found.
///
/// A chessboard is found whole or not at all. Which end is first: the one with a dark square
/// inside, where the board's turns differ in that; else the one whose rows run to the right, which
/// is another one once the camera has rolled (`board_symmetries`). Of a ChArUco board corners may
/// be hidden, which are NaN; its markers tell the ends apart. So do the tags of a board of tags.
std::vector<Eigen::Vector2d> find_board(const cv::Mat& gray, const Board& board);

/// Sub-pixel corners by windows of half so wide; one that moves by more than `reach_px` stays where
/// it was. Returns which moved no further.
std::vector<bool> refine_corners(std::vector<cv::Point2f>& corners,
                                 const cv::Mat& gray,
                                 int half_px,
                                 double reach_px);

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

/// How many different tags there are in the family 36h11.
int april_tag_count();

/// Corners of a board of tags [raw px], as `find_board` gives them: of the tags that are seen, the
/// others NaN. Empty where there is none. Tags are numbered as Kalibr prints them: from the bottom
/// row on, from left to right.
std::vector<Eigen::Vector2d> find_april_tags(const cv::Mat& gray, const Board& board);

}  // namespace gpo
