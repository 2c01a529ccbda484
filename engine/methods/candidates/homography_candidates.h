// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <span>
#include <stop_token>
#include <vector>

namespace gpo {

/// A decomposition is the false one if its rotation is worse than its twin's by this angle and by
/// this factor. A gyroscope bias of 0.01 rad/s adds half a degree per second.
inline constexpr double kClearlyWorseDeg = 0.5;
inline constexpr double kClearlyWorseFactor = 2;

/// Returns all decompositions of the homography from frame 0 to `frame` with their scores; at most
/// two are accepted, the others put points behind a camera.
std::vector<HomographyCandidate> decompose_frame(const Window& window, int frame);

/// Rejects candidates of one frame whose rotation is clearly worse than that of another one.
void reject_worse_rotations(std::span<HomographyCandidate> candidates);

/// Returns the candidates of every frame after `reject_worse_rotations`; none for the reference
/// frame and without a homography. Incomplete if stopped.
std::vector<std::vector<HomographyCandidate>> candidates_of_window(
    const Window& window, const std::stop_token& stop = {});

/// Returns the accepted candidate with the best score; null if there is none.
const HomographyCandidate* best_of(std::span<const HomographyCandidate> candidates);

}  // namespace gpo
