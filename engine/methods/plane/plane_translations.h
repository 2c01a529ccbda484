// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <Eigen/Core>

namespace gpo {

/// tau of a frame given the plane's normal and the window's rotation, by linear least squares
/// (engine/method.md, eq. 9) over the frame's inliers, weighted to pixel errors in three rounds.
Eigen::Vector3d translation_given_normal(const Window& window,
                                         int frame,
                                         const Eigen::Vector3d& normal);

}  // namespace gpo
