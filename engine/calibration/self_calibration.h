// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_lens.h"
#include "engine/recording/frame_cache.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>

namespace gpo {

/// Result of a calibration without a board.
struct SelfCalibration {
  PlaneLens lens;
  bool gyroscope = false;  ///< whether a gyroscope contributed
};

/// Receives the current step and its progress: "following a plane", 41 of 60.
using CalibrationProgress = std::function<void(const char* what, int done, int of)>;

/// A gyroscope with its axes in those of the camera, and the time of each frame (camera clock).
struct TimedGyroscope {
  const Gyroscope* gyroscope = nullptr;
  std::span<const std::int64_t> frame_times_ns = {};
};

/// Calibrates a camera by a plane in its images (engine/method.md, "The lens from the plane").
/// `guess` has the size of the images and roughly their field of view. Throws InputError if an
/// image cannot be decoded.
SelfCalibration calibrate_from_plane(const FrameCache& images,
                                     const Camera& guess,
                                     const TimedGyroscope& timed = {},
                                     const CalibrationProgress& progress = {},
                                     const std::stop_token& stop = {});

}  // namespace gpo
