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

/// Called for each frame that was looked at, by one thread at a time.
using BoardProgress = std::function<void(int done, int of)>;

/// Camera poses in the board's frame (z into the board), one for each of `frames`, which ascend. A
/// frame has none where the board is not found, or where its fit's RMS is above 0.5 px and above
/// four times the median of them all.
///
/// Each frame is looked at by itself, on all processors, and once only: the recording's cache
/// folder, if it has one, keeps what was found. Of a board that looks the same turned, the pose
/// nearest in rotation to the last one found is taken then; in the first frame the one whose rows
/// run to the right.
///
/// The recording must have pictures and a board. Once stopped it returns what it has within about
/// one frame's time. Throws InputError for pictures that cannot be decoded.
GroundTruth board_truth(const Recording& recording,
                        const std::vector<int>& frames,
                        const std::stop_token& stop = {},
                        const BoardProgress& progress = {});

/// The same for `frames` frames from `start` on. The median is that of 30 frames from `start` on
/// (fewer where the recording ends), so that a frame's pose does not depend on the window's length.
GroundTruth board_truth(const Recording& recording,
                        int start,
                        int frames,
                        const std::stop_token& stop = {},
                        const BoardProgress& progress = {});

/// The median of each number over the frames that have a pose; nothing where none has.
std::optional<PoseUncertainty> median_uncertainty(
    std::span<const std::optional<PoseUncertainty>> uncertainties);

/// "0.31 mm, 0.05 deg, its normal 0.04 deg (one standard deviation; fit 0.21 px RMS)".
std::string uncertainty_text(const PoseUncertainty& uncertainty);

/// What was found in the frames looked at so far, by frame; nothing where it was no board. Each
/// frame by itself: which of the board's symmetric poses it is, is not decided yet.
using BoardViews = std::map<int, std::optional<BoardPose>>;

/// The file in the recording's cache folder for these pictures (their absolute paths, sizes and
/// times of change), this camera and this board. Nothing where there is no such folder, or the
/// pictures are not from files.
std::optional<std::filesystem::path> board_cache_file(const Recording& recording);

/// Empty where there is no such file, or it is not one of ours, cut or damaged.
BoardViews load_board_views(const std::filesystem::path& file);

/// Adds them to what is in the file by now. A folder that cannot be written to is no error: what
/// is missing will be computed again.
void save_board_views(const std::filesystem::path& file, const BoardViews& views);

}  // namespace gpo
