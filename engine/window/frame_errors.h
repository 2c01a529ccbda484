// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <vector>

namespace gpo {

/// One a frame, zero of the reference frame and of one without inliers: the window's own, where
/// its maker computed them.
std::vector<FrameErrors> frame_errors(const Window& window);

/// What the homographies leave: the median over the frames of an inlier's median transfer error
/// [px].
double homography_error_px(const Window& window);

}  // namespace gpo
