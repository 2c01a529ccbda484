// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <span>

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

/// Returns the numbers of inner corners (the larger one first) of the chessboard that an image
/// shows; nullopt if there is none. Counts may be too small or too large in single images.
std::optional<cv::Size> chessboard_counts(const cv::Mat& gray);

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
/// Number of markers in a dictionary; a board needs one for each of its white squares.
int dictionary_size(const std::string& dictionary);
/// Number of markers on a board, one in each white square.
int marker_count(const Board& board);

/// Number of tags in the family 36h11.
int april_tag_count();

/// Finds boards of OpenCV up to 4.5, which may begin with a white square, and later ones.
std::vector<Eigen::Vector2d> find_charuco(const cv::Mat& gray, const Board& board);
/// Tags are numbered as Kalibr prints them: from the bottom row up, from left to right.
std::vector<Eigen::Vector2d> find_april_tags(const cv::Mat& gray, const Board& board);

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
/// fit exceeds `most_rms` [pixel_unit].
///
/// The covariance is s^2 (J^T J)^-1, s^2 = r^T r / (2 n - 6), with the residuals r of n corners.
std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector2d>& corners_raw_px,
                                    const Board& board,
                                    const Camera& camera,
                                    double most_rms = 2);

/// Projects the board's corners into the image [raw px].
std::vector<Eigen::Vector2d> project_board(const Board& board,
                                           const Camera& camera,
                                           const Pose& pose);

/// Returns the rigid motions of the board onto itself that no image distinguishes, T_board_board,
/// the identity first: half a turn if the numbers of corners are both even or both odd, quarter
/// turns if they are equal and even, only the identity with markers or tags.
std::vector<Pose> board_symmetries(const Board& board);

/// Corners by frame, as `find_board` returns them.
using BoardCorners = std::map<int, std::vector<Eigen::Vector2d>>;

/// Returns the velocities of a frame's corners [raw px/s] by up to two frames on each side; empty
/// if fewer than two neighbors show the board, or if it does not move evenly from one to the next.
/// The frame must be in `corners`.
std::vector<Eigen::Vector2d> corner_velocities(const BoardCorners& corners,
                                               int frame,
                                               std::span<const std::int64_t> timestamps_ns);

/// Moves corners [raw px] that a rolling shutter read later or earlier to the time stamp, by their
/// velocities [raw px/s].
std::vector<Eigen::Vector2d> at_time_stamp(std::vector<Eigen::Vector2d> corners,
                                           const std::vector<Eigen::Vector2d>& velocities_px_s,
                                           const Camera& camera,
                                           double readout_s);

/// Returns the minimum of the parabola through sums of squared errors [px^2] at three readout
/// times, one step before it, at it and one step after it, relative to the middle one, and its
/// standard deviation with `freedom` degrees of freedom. nullopt if there is no minimum.
std::optional<Readout> least_readout(const Eigen::Array3d& squares_px2,
                                     double step_s,
                                     double freedom);

/// Estimates the readout time of a calibrated camera as that with the least reprojection errors of
/// the board in these frames, each with its own pose. nullopt if it is below three standard
/// deviations, or if fewer than ten frames have velocities. Its standard deviation contains the
/// error of the lens and the largest of a jackknife's over blocks of time, 1 ms, and the least
/// squares' of one frame, because a bent board moves its corners alike in all; twice that, as real
/// recordings show.
std::optional<Readout> readout_from_board(const BoardCorners& corners,
                                          std::span<const int> frames,
                                          std::span<const std::int64_t> timestamps_ns,
                                          const Board& board,
                                          const Camera& camera);

/// Called after each processed frame, by one thread at a time.
using BoardProgress = std::function<void(int done, int of)>;

/// Computes camera poses in the board's frame (z into the board), one for each of the ascending
/// `frames`. A frame has none if the board is not found, or if the RMS of its fit exceeds both
/// 0.5 px and four times the median of all frames.
///
/// If the camera has a readout time, the corners are moved to the time stamp by their velocities in
/// neighboring frames. A frame without velocities then has no pose. An unknown readout time is
/// estimated from the corners (`readout_from_board`), and 0 if it is not significant.
///
/// Frames are processed in parallel. The recording's cache folder, if any, keeps the corners so
/// that each frame is processed only once. Among symmetric poses a frame gets the one nearest in
/// rotation to the previous frame's, and the first frame the one whose rows run to the right.
///
/// The recording must have images and a board. After a stop request it returns the poses so far,
/// within about one frame's time. Throws InputError if an image cannot be decoded.
GroundTruth board_truth(const Recording& recording,
                        const std::vector<int>& frames,
                        const std::stop_token& stop = {},
                        const BoardProgress& progress = {});

/// The same for `frames` frames from `start`, with the median and the readout time of the first 30
/// frames (fewer at the end of the recording), so that a pose does not depend on the window's
/// length.
GroundTruth board_truth(const Recording& recording,
                        int start,
                        int frames,
                        const std::stop_token& stop = {},
                        const BoardProgress& progress = {});

/// Returns the median of each number over the frames that have a pose; nullopt if none has.
std::optional<PoseUncertainty> median_uncertainty(
    std::span<const std::optional<PoseUncertainty>> uncertainties);

/// "0.31 mm, 0.05 deg, board normal 0.04 deg (1 sigma; fit 0.21 px RMS)".
std::string uncertainty_text(const PoseUncertainty& uncertainty);

/// Cache file for these images (paths, sizes, times) and board; nullopt without a folder.
std::optional<fs::path> board_cache_file(const Recording& recording);

/// Empty if the file is missing, truncated, damaged or no cache of corners.
BoardCorners load_board_corners(const fs::path& file);

/// Adds corners to the file. Ignores write errors: they will be searched again.
void save_board_corners(const fs::path& file, const BoardCorners& corners);

}  // namespace gpo
