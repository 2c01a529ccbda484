// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"
#include "engine/window/tracks.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace gpo {

/// tracks.csv (`frame,track,x,y`, raw pixels, then what you like), sorted by frame, then track. A
/// frame must be below `frame_count` where that is known. Throws InputError.
std::vector<TrackObservation> read_tracks(const std::filesystem::path& file,
                                          std::optional<int> frame_count);

}  // namespace gpo
