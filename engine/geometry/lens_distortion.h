// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"

#include <Eigen/Core>

namespace gpo {

/// What the lens does to normalized coordinates (x / z, y / z): where the pinhole's point appears.
/// NaN beyond the model's valid radius, where the polynomial folds back and maps two directions to
/// one pixel.
Eigen::Vector2d distort_normalized(const Camera& camera, const Eigen::Vector2d& ideal);

/// The inverse, by Newton's method to `tolerance` (normalized). NaN where there is none within the
/// valid radius.
Eigen::Vector2d undistort_normalized(const Camera& camera,
                                     const Eigen::Vector2d& distorted,
                                     double tolerance);

}  // namespace gpo
