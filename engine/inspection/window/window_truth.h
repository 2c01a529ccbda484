// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/window/progress.h"
#include "engine/recording/recording.h"
#include "engine/truth/truth.h"

#include <memory>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The recording's own truth of a window, or that of the board in its pictures; null where there is
/// neither.
std::shared_ptr<const WindowTruth> window_truth(const Recording& recording,
                                                int start,
                                                int frames,
                                                const std::stop_token& stop,
                                                const Progress& progress);

/// The first frames of a longer window's; null of null.
std::shared_ptr<const WindowTruth> beginning(const std::shared_ptr<const WindowTruth>& whole,
                                             int frames);

/// The board's corners in the reference picture [raw px], for the cube; those that are hidden from
/// its pose. Empty where there is no board.
std::vector<Eigen::Vector2d> corners_in(const Recording& recording, int frame);

}  // namespace gpo
