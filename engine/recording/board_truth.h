// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// The chessboard as seen in one picture: corners row by row [raw px], sub-pixel, rows x columns of
/// them, ordered so that (along a row) x (along a column) points away from the camera. A board
/// whose corner counts are both even or both odd looks the same upside down: `previous` (the
/// corners of an earlier frame, may be empty) decides which end is first. Empty where no board is
/// found.
std::vector<Eigen::Vector2d> find_board(const cv::Mat& gray,
                                        const Board& board,
                                        const std::vector<Eigen::Vector2d>& previous = {});

/// Corners on the board's plane z = 0 [m], in the order of `find_board`: x along a row, y along a
/// column, so z points into the board, away from the camera.
std::vector<Eigen::Vector3d> board_points(const Board& board);

/// Camera pose in the board's frame by PnP on the undistorted corners (IPPE, refined), and the root
/// mean square of the reprojection error [undistorted px]. Nothing where that is above 2 px.
struct BoardPose {
  Pose pose;
  double rms_px = 0;
};
std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector2d>& corners_raw_px,
                                    const Board& board,
                                    const Camera& camera);

/// Camera poses in the board's frame for `frames` frames from `start` on (poses[0] is that of frame
/// `start`), by looking for the board in each picture in turn. A frame in which it is not found has
/// none. The recording must have pictures and a board. Once stopped it returns what it has within
/// one frame's time. Throws InputError for pictures that cannot be decoded.
GroundTruth board_truth(const Recording& recording,
                        int start,
                        int frames,
                        const std::stop_token& stop = {},
                        const std::function<void(int done, int of)>& progress = {});

}  // namespace gpo
