// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// GPO for the first frames of a window.
struct GrowthStep {
  int frames = 0;
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  Verdict numbers;     ///< not judged
  int linearized = 0;  ///< number of frames linearized in this step
};

/// Runs GPO for every length from 2 frames on, each started from the previous one: a frame's errors
/// are linearized when it is added, and again only after the normal has changed. Empty if a frame
/// has too few inliers or no homography; incomplete if stopped. The standard deviations
/// are those of independent noise times the correlation factor of the whole window, and
/// the lens' contribution to the whole window.
std::vector<GrowthStep> grow(const Window& window,
                             Lens lens = Lens::typical,
                             const std::stop_token& stop = {});

}  // namespace gpo
