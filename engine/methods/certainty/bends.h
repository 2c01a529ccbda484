// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/plane/plane_motion.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Returns the variation of each plane's normal over a surface that is not flat: a quadratic is
/// fitted to the tracks' heights above the plane, and this is the second moment of its slopes at
/// the tracks around their mean, over the plane's tangents [rad^2] (engine/method.md, eq. 14d).
/// Without a gyroscope it is fitted together with the motion. Relief, curved paper and lens errors
/// contribute. nullopt if the curvature is not significant. `sigma_px`: noise of a coordinate.
std::vector<std::optional<Eigen::Matrix2d>> bends_of(const SolvedPlanes& solved, double sigma_px);

/// Widens the covariances of bias and time offset by the ratio in which errors that neighboring
/// tracks share and bends widen that of the normal, up to their priors (engine/method.md, eq. 14k).
void widen_gyro(const Window& window, double ratio, Uncertainty& u);

/// Adds the variation of all normals over surfaces that are not flat.
void add_bends(const SolvedPlanes& solved, Uncertainty& u);

}  // namespace gpo
