// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/verdict.h"
#include "engine/window/window.h"

#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// GPO and the verdict on the window's first frames.
struct GrowthStep {
  int frames = 0;
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  Verdict verdict;
  int linearized = 0;  ///< frames whose errors were linearized for this step
};

/// GPO at every length from 2 frames on, each step warm from the one before: a frame's errors are
/// linearized when it comes, and again only where the normal has since moved. Empty where a frame
/// has too few inliers or no homography; ends early where it is stopped. The
/// verdicts' standard deviations are those of independent noise times what the whole window says of
/// how dependent it is.
std::vector<GrowthStep> grow(const Window& window, const std::stop_token& stop = {});

}  // namespace gpo
