// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/uncertainty.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_observations.h"
#include "engine/window/window.h"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace gpo {

/// Whether the covariance of all centers at once is computed, too, which takes a millisecond or
/// two of 30 frames and grows with the square of their number.
enum class Centers { one_by_one, jointly };

/// Of a solution on the window's inliers, by a method to which so much of the rotations is unknown.
/// Nothing where the solution is not determined or a point lies behind a camera.
std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const Plane& plane,
                                          std::span<const Pose> cameras,
                                          RotationModel rotations,
                                          Centers centers = Centers::one_by_one);

/// The same of a solution over several planes whose observations are weighted.
std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const PlaneObservations& observations,
                                          const PlaneMotion& motion,
                                          RotationModel rotations,
                                          Centers centers = Centers::one_by_one);

}  // namespace gpo
