// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <functional>
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

}  // namespace gpo
