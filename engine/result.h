// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/eigen_layout.h"
#include "engine/diagnosis/finding.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/methods/common/initialization.h"
#include "engine/rotations/rotations.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// A window's result. World = its first camera; unit = the leading plane's distance from it.
struct WindowResult {
  /// `ok` or a reason; cameras, points, planes, uncertainty, verdict.
  Initialization initialization;
  std::vector<std::int64_t> ids;  ///< ids of the window's tracks, indexed by `MapPoint::track`
  RotationSource rotations = RotationSource::gyro;  ///< the source used, never automatic
  /// Why the gyroscope is not used as given, or why the first choice of `automatic` failed.
  std::string rotations_note;
  Window window;  ///< undistorted points, inliers, homographies, given rotations
  /// Gravity and metric scale; nullopt if the result is not ok or there are no accelerations.
  std::optional<InertialAlignment> inertial = std::nullopt;
  std::vector<Finding> findings = {};  ///< the heaviest first; the verdict's reason is the first

  /// Returns whether the result is ok and the verdict on its window `ready`.
  bool is_ready() const;
  /// Returns why it is not, in one sentence; empty if it is.
  std::string why_not_ready() const;
  /// Returns whether the accelerometer determines the metric scale.
  bool is_metric() const;
};

}  // namespace gpo
