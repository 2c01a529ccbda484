// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/rotations.h"
#include "engine/window/window.h"

#include <span>
#include <stop_token>

#include <Eigen/Core>

namespace gpo {

/// Rotations of a window's cameras from its pictures alone: homographies between pairs of frames
/// are decomposed, the candidates whose plane normal agrees over the window are kept, and their
/// rotations averaged. On a plane these are far better than five-point rotations
/// (`tests/engine/frontend/homography_rotations_test.cpp` measures both). Where the homographies
/// allow no consistent choice, or two planes alike, there are none and a reason; none either where
/// stopped.
Rotations averaged_rotations(const Window& window, const std::stop_token& stop = {});

/// The same, but which of several planes is told by rotations that are known roughly, say a
/// gyroscope's: one a frame.
Rotations averaged_rotations(const Window& window,
                             std::span<const Eigen::Matrix3d> R_wc_given,
                             const std::stop_token& stop = {});

}  // namespace gpo
