// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/relative_pose.h"
#include "engine/frontend/rotations.h"
#include "engine/window/window.h"

#include <cstdint>
#include <stop_token>

namespace gpo {

struct PairRotationOptions {
  RelativeSolver solver = RelativeSolver::five_point;
  double threshold_px = 2.0;  ///< largest distance of an inlier from the epipolar geometry [px]
  std::uint64_t seed = 1;     ///< of the random samples
};

/// Rotations of a window's cameras from all its tracks, on whatever surface they are: relative
/// poses of pairs of frames by RANSAC, their rotations averaged (Chatterjee & Govindu). Where one
/// plane explains nearly all tracks they are ambiguous, so that there are none, with a reason; none
/// either where too few tracks join a frame to the first, or where stopped.
Rotations pair_rotations(const Window& window,
                         const PairRotationOptions& options,
                         const std::stop_token& stop = {});

}  // namespace gpo
