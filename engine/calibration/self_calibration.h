// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_lens.h"
#include "engine/calibration/plane_views/linked_views.h"
#include "engine/calibration/plane_views/plane_chain.h"
#include "engine/recording/frame_cache.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

namespace gpo {

struct SelfCalibrationOptions {
  int most_frames = 400;  ///< that are looked at
  int most_planes = 4;    ///< the longest stretches through which a plane is followed
  ChainOptions chain = {};
  LinkOptions link = {};
  PlaneLensOptions lens = {};
};

/// A camera from what it sees, or why there is none.
struct SelfCalibration {
  PlaneLens lens;
  int frames = 0;          ///< looked at
  int chains = 0;          ///< stretches of time through which a plane was followed
  bool gyroscope = false;  ///< helped
};

/// Told of what is done: "following a plane", 41 of 60.
using CalibrationProgress = std::function<void(const char* what, int done, int of)>;

/// Calibrates a camera from a plane that its own pictures show (engine/method.md, "The lens from
/// the plane"). `guess` has the pictures' size and roughly their field of view. The gyroscope, if
/// any, needs its axes in the camera's; `frame_times_ns` is one a picture then. Throws InputError
/// where a picture cannot be decoded.
SelfCalibration calibrate_from_plane(const FrameCache& images,
                                     const Camera& guess,
                                     const Gyroscope* gyroscope = nullptr,
                                     std::span<const std::int64_t> frame_times_ns = {},
                                     const SelfCalibrationOptions& options = {},
                                     const CalibrationProgress& progress = {},
                                     const std::stop_token& stop = {});

/// camera.yaml as `read_calibration` reads it; `source`: what was calibrated, for people.
std::string to_yaml(const SelfCalibration& calibration, const std::string& source);

/// A table for people, each line ended.
std::string to_text(const SelfCalibration& calibration);

}  // namespace gpo
