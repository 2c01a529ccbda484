// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <span>
#include <stop_token>
#include <vector>

namespace gpo {

/// A reading whose rotation is at least this much worse than its twin's, in deg and as a multiple,
/// is the false one: half a degree is what a gyroscope's bias of 0.01 rad/s adds in a second.
inline constexpr double kClearlyWorseDeg = 0.5;
inline constexpr double kClearlyWorseFactor = 2;

/// Returns all readings of the homography from frame 0 to `frame`, scored; those that put points
/// behind a camera are rejected, which leaves at most two.
std::vector<HomographyCandidate> read_homography(const Window& window, int frame);

/// Rejects readings whose rotation is clearly worse than that of another one in `candidates` (of
/// one frame).
void reject_worse_rotations(std::span<HomographyCandidate> candidates);

/// `read_homography` of every frame, with its worse rotations rejected; one a frame of the window,
/// none of the reference frame and where it has no homography. Ends early where stopped.
std::vector<std::vector<HomographyCandidate>> candidates_of_window(
    const Window& window, const std::stop_token& stop = {});

/// The reading with the best score of those not rejected; null where there is none.
const HomographyCandidate* best_of(std::span<const HomographyCandidate> candidates);

}  // namespace gpo
