// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/tracks.h"
#include "ui/workbench/state.h"

#include <cstdint>
#include <vector>

namespace gpo {

// Tracks of the current inspection, by their ids, ascending. Empty where there is none, and, of
// those that speak of a frame, where it is outside of the window.

std::vector<std::int64_t> tracks_of_window(const WorkbenchState& state);
/// Seen in the current frame.
std::vector<std::int64_t> tracks_in_view(const WorkbenchState& state);
/// ... and no inliers there.
std::vector<std::int64_t> outliers_in_view(const WorkbenchState& state);
/// ... and between two corners [raw px].
std::vector<std::int64_t> tracks_within(const WorkbenchState& state,
                                        const Eigen::Vector2d& a,
                                        const Eigen::Vector2d& b);

/// Column in the window of the track with this id; nothing where the window has none.
std::optional<int> column_of(const Tracks& tracks, std::int64_t id);

}  // namespace gpo
