// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <span>

#include <opencv2/core.hpp>

namespace gpo {

/// Corners [raw px] in the order of `board_points`; (along a row) x (along a column) points away
/// from the camera. Empty without a board. A chessboard's first corner is beside a dark square, or
/// its rows run to the right (`board_symmetries`). With markers or tags hidden corners are NaN.
std::vector<Eigen::Vector2d> find_board(const cv::Mat& gray, const Board& board);

/// Refines to sub-pixels; corners that would move by more than `reach_px` stay and are false.
std::vector<bool> refine_corners(std::vector<cv::Point2f>& corners,
                                 const cv::Mat& gray,
                                 int half_px,
                                 double reach_px);

/// Returns OpenCV's full name of a dictionary: "5x5_100" -> "DICT_5X5_100". nullopt if unknown.
std::optional<std::string> dictionary_name(const std::string& name);
std::string dictionary_names();
int dictionary_size(const std::string& dictionary);
int marker_count(const Board& board);

int april_tag_count();

/// Finds boards of OpenCV up to 4.5, which may begin with a white square, and later ones.
std::vector<Eigen::Vector2d> find_charuco(const cv::Mat& gray, const Board& board);
/// Tags are numbered as Kalibr prints them: from the bottom row up, from left to right.
std::vector<Eigen::Vector2d> find_april_tags(const cv::Mat& gray, const Board& board);

const char* board_title(const Board& board);

/// Corners on z = 0 [m], row by row: x along a row, y along a column, z away from the camera.
std::vector<Eigen::Vector3d> board_points(const Board& board);

struct BoardPose {
  Pose pose;
  PoseUncertainty uncertainty;
};

/// PnP (IPPE, then least squares in raw pixels) without NaN corners. nullopt for fewer than 6 (4 of
/// a single tag), all but one collinear, or an RMS above 2 px.
std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector2d>& corners_raw_px,
                                    const Board& board,
                                    const Camera& camera);

std::vector<Eigen::Vector2d> project_board(const Board& board,
                                           const Camera& camera,
                                           const Pose& pose);

/// Motions of the board onto itself that no image distinguishes, the identity first.
std::vector<Pose> board_symmetries(const Board& board);

using BoardProgress = std::function<void(int done, int of)>;

/// Camera poses in the board's frame (z into the board) of the ascending `frames`; none for an RMS
/// above 0.5 px and four times the median. A symmetric board has the pose nearest to the previous
/// one. Uses the recording's cache folder. Returns the poses so far if stopped. Throws InputError.
GroundTruth board_truth(const Recording& recording,
                        const std::vector<int>& frames,
                        const std::stop_token& stop = {},
                        const BoardProgress& progress = {});

/// For `frames` frames from `start`, with the median of the first 30, whatever the window's length.
GroundTruth board_truth(const Recording& recording,
                        int start,
                        int frames,
                        const std::stop_token& stop = {},
                        const BoardProgress& progress = {});

/// Returns the median of each number over the frames that have a pose; nullopt if none has.
std::optional<PoseUncertainty> median_uncertainty(
    std::span<const std::optional<PoseUncertainty>> uncertainties);

std::string uncertainty_text(const PoseUncertainty& uncertainty);

using BoardViews = std::map<int, std::optional<BoardPose>>;

/// Cache file for these images (paths, sizes, times), camera and board; nullopt without a folder.
std::optional<fs::path> board_cache_file(const Recording& recording);

/// Empty if the file is missing, truncated, damaged or no cache of board views.
BoardViews load_board_views(const fs::path& file);

/// Adds views to the file. Ignores write errors: the views will be computed again.
void save_board_views(const fs::path& file, const BoardViews& views);

}  // namespace gpo
