// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/window/window.h"

#include <optional>
#include <span>

namespace gpo {

/// Cramer-Rao bound of the normal's angle [deg] (engine/method.md, eq. 13 and 14): the root of the
/// trace of its covariance with the translations unknown, rotations known, reference points exact
/// and independent noise of `sigma_px` on each coordinate of the inlier observations. Nothing where
/// the window does not determine it.
std::optional<double> normal_bound_deg(const Window& window,
                                       const Plane& plane,
                                       std::span<const Pose> cameras,
                                       double sigma_px);

}  // namespace gpo
