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

/// Camera pose in the board's frame, and how sure it is.
struct BoardPose {
  Pose pose;
  PoseUncertainty uncertainty;
};

/// By PnP (IPPE, then the least squares of the distances in raw pixels) on the corners of
/// `find_board`, of which those that are NaN are left out. Nothing where fewer than 6 (of a single
/// tag 4) are left or all but one of them are on a line, or where the fit's RMS is above 2 px.
///
/// The covariance is s^2 (J^T J)^-1 with s^2 = r^T r / (2 n - 6) of n corners' residuals r.
std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector2d>& corners_raw_px,
                                    const Board& board,
                                    const Camera& camera);

/// Where the board's corners are in the picture [raw px], from a pose.
std::vector<Eigen::Vector2d> project_board(const Board& board,
                                           const Camera& camera,
                                           const Pose& pose);

/// The rigid motions of the board onto itself that no picture tells apart, T_board_board; the
/// first is the identity. A half turn where the counts of corners are both even or both odd,
/// quarter turns where they are equal and even; nothing but the identity with markers or tags.
std::vector<Pose> board_symmetries(const Board& board);

}  // namespace gpo
