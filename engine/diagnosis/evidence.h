// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/evaluation/truth_conventions.h"
#include "engine/geometry/camera.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/methods/methods.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace gpo {

/// A remark that a stage made before the checks.
struct Remark {
  std::string_view key;  ///< key of the check that reports it
  std::string sentence;
  std::string advice = {};
};

/// Known facts about a recording, its window and the result. Null or empty: unknown.
struct Evidence {
  // The recording.
  const Camera* camera = nullptr;
  bool camera_is_guess = false;
  double intrinsics_scale = 1;  ///< by which `camera` differs from the calibration
  double pixel_aspect = 1;      ///< width of a pixel divided by its height, as the images state
  std::string_view first_field = {};  ///< "top" or "bottom" if the video is interlaced
  const Gyroscope* gyroscope = nullptr;
  std::span<const Remark> remarks = {};
  // The window.
  const Window* window = nullptr;
  const Tracks* tracks = nullptr;          ///< columns as those of the window
  std::span<const std::int64_t> ids = {};  ///< ids of the window's columns
  const Verdict* numbers = nullptr;  ///< numbers of the window or its first frames, not judged yet
  // The result.
  const Method* method = nullptr;
  Lens lens = Lens::typical;
  const Initialization* result = nullptr;
  const InertialAlignment* inertial = nullptr;
  // The ground truth.
  const WindowTruth* truth = nullptr;
  const Evaluation* evaluation = nullptr;
  const TruthConvention* truth_convention = nullptr;

  /// Returns the result's uncertainty; null if it has none.
  const Uncertainty* uncertainty() const {
    return result != nullptr && result->uncertainty ? &*result->uncertainty : nullptr;
  }
};

}  // namespace gpo
