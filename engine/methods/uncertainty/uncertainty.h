// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/plane/plane_motion.h"

#include <optional>
#include <span>

namespace gpo {

/// of_noise: without the bend of the surface, and without `Uncertainty::joint_covariance`, which
/// takes 1 to 2 ms for 30 frames and grows with the square of their number.
enum class Errors { of_noise, all };

/// Returns the uncertainty of a solution over weighted observations, by a method for which the
/// rotations are unknown to the extent of `rotations`. nullopt if the solution is not determined or
/// a point is behind a camera.
std::optional<Uncertainty> uncertainty_of(const SolvedPlanes& solved,
                                          RotationModel rotations,
                                          Errors errors = Errors::all);

/// Returns the same for a solution on the window's inliers with equal weights.
std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const Plane& plane,
                                          std::span<const Pose> cameras,
                                          RotationModel rotations);

/// Adds a typical error of the calibration (`Uncertainty::typical_lens_moves`) to all covariances
/// but those of `normal_covariance`, which `typical_lens_sigma_deg` complements.
void add_typical_lens(Initialization& result);

}  // namespace gpo
