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

struct InlierOptions {
  RansacOptions ransac = {};
  Inliers inliers = Inliers::per_frame;
  int leader = 0;  ///< the leading plane, counted from 0 by support (`Inliers::planes`)
};

/// Undistorts the tracks and selects inliers: between the reference frame and each other frame, and
/// for `Inliers::consistent` also over the window if enough tracks are consistent, or by extracting
/// the window's planes. Rotations are left at the identity. `recording_timestamps_ns` has all
/// frames of the recording.
Window make_window(const Tracks& tracks,
                   const Camera& camera,
                   std::span<const std::int64_t> recording_timestamps_ns,
                   const InlierOptions& options);

}  // namespace gpo
