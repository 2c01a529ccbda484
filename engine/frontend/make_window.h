// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/inliers.h"
#include "engine/geometry/camera.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <cstdint>
#include <span>

namespace gpo {

/// Undistorts the tracks once and rejects outliers between the reference frame and each other
/// frame, then also over the window where `inliers` says so and enough tracks are consistent; or
/// tells the planes of the window, of which number `leader` (from 0) leads. Rotations are left at
/// the identity. `recording_timestamps_ns` are those of all frames of the recording.
Window make_window(const Tracks& tracks,
                   const Camera& camera,
                   std::span<const std::int64_t> recording_timestamps_ns,
                   const RansacOptions& ransac,
                   Inliers inliers = Inliers::per_frame,
                   int leader = 0);

}  // namespace gpo
