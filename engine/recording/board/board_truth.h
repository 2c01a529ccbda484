// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/board/board_pose.h"
#include "engine/recording/recording.h"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace gpo {

/// Called after each processed frame, by one thread at a time.
using BoardProgress = std::function<void(int done, int of)>;

/// Computes camera poses in the board's frame (z into the board), one for each of `frames`, which
/// ascend. A frame has none if the board is not found, or if the RMS of its fit exceeds both 0.5 px
/// and four times the median of all frames.
///
/// All processors work on different frames. The recording's cache folder, if any, keeps the results
/// so that each frame is processed once only. If the board has symmetries, a frame gets the pose
/// nearest in rotation to the previous one, and the first frame the one whose rows run to the
/// right.
///
/// The recording must have images and a board. After a stop request it returns the poses so far,
/// within about one frame's time. Throws InputError if an image cannot be decoded.
GroundTruth board_truth(const Recording& recording,
                        const std::vector<int>& frames,
                        const std::stop_token& stop = {},
                        const BoardProgress& progress = {});

/// The same for `frames` frames from `start` on, with the median of the first 30 frames from
/// `start` (fewer at the end of the recording), so that a pose does not depend on the window's
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

/// Results of the processed frames, before one of the board's symmetric poses is chosen; nullopt if
/// the frame shows no board.
using BoardViews = std::map<int, std::optional<BoardPose>>;

/// Returns the file in the recording's cache folder for these images (absolute paths, sizes, times
/// of change), this camera and this board. nullopt if there is no cache folder or the images are
/// not from files.
std::optional<std::filesystem::path> board_cache_file(const Recording& recording);

/// Empty if the file is missing, foreign, truncated or damaged.
BoardViews load_board_views(const std::filesystem::path& file);

/// Adds views to the file. A folder that cannot be written to is no error: the views will be
/// computed again.
void save_board_views(const std::filesystem::path& file, const BoardViews& views);

}  // namespace gpo
