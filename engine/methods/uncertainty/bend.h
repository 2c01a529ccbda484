// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/uncertainty/information.h"

#include <optional>

namespace gpo {

/// Returns the standard deviation of the main plane's normal over a surface that is not flat [deg]:
/// a quadratic is fitted to the tracks' heights above the plane, and its slopes at the tracks vary
/// by this around their mean (engine/method.md, eq. 14d). Without a gyroscope it is fitted together
/// with the motion. Relief, curved paper and lens errors contribute. nullopt if the curvature is
/// not significant. `sigma_px`: noise of a coordinate.
std::optional<double> bend_sigma_deg(const SolvedPlanes& solved, double sigma_px);

}  // namespace gpo
