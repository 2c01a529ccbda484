// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/board/board_pose.h"
#include "engine/recording/recording.h"

#include <filesystem>
#include <map>
#include <optional>

namespace gpo {

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
