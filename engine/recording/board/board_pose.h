// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// "chessboard", "ChArUco board", "AprilGrid" or "AprilTag".
const char* board_title(const Board& board);

/// Corners on the board's plane z = 0 [m], row by row: x along a row, y along a column, so z points
/// into the board, away from the camera.
std::vector<Eigen::Vector3d> board_points(const Board& board);

/// Camera pose in the board's frame and its uncertainty.
struct BoardPose {
  Pose pose;
  PoseUncertainty uncertainty;
};

/// Estimates the camera pose by PnP (IPPE, then least squares of the reprojection errors in raw
/// pixels) from the corners of `find_board`; NaN corners are ignored. nullopt if fewer than 6
/// corners remain (4 for a single tag), if all but one of them are collinear, or if the RMS of the
/// fit exceeds 2 px.
///
/// The covariance is s^2 (J^T J)^-1, s^2 = r^T r / (2 n - 6), with the residuals r of n corners.
std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector2d>& corners_raw_px,
                                    const Board& board,
                                    const Camera& camera);

/// Projects the board's corners into the image [raw px].
std::vector<Eigen::Vector2d> project_board(const Board& board,
                                           const Camera& camera,
                                           const Pose& pose);

/// Returns the rigid motions of the board onto itself that no image distinguishes, T_board_board,
/// the identity first: half a turn if the numbers of corners are both even or both odd, quarter
/// turns if they are equal and even, only the identity with markers or tags.
std::vector<Pose> board_symmetries(const Board& board);

}  // namespace gpo
