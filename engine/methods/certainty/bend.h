// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_observations.h"

#include <optional>

#include <Eigen/Core>

namespace gpo {

/// How the normal varies over a plane that is none: every track's height above it is what would
/// explain its errors, a quadratic through the heights has a slope at every track, and this is the
/// slopes' second moment around their mean, over the plane's tangents [rad^2] (engine/method.md,
/// eq. 14d). Relief, curved paper and a lens that bends what is straight all show in it. Nothing
/// where the quadratic's curvature does not stand out of the heights' noise. `plane`: 0 the leading
/// one, then the further ones; `sigma_px` of a coordinate.
std::optional<Eigen::Matrix2d> bend_of(const PlaneObservations& observations,
                                       const PlaneMotion& motion,
                                       int plane,
                                       double sigma_px);

}  // namespace gpo
