// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/lens_models.h"

#include <Eigen/Core>

namespace gpo {

using Coefficients = std::span<const double>;

/// A lens model's mapping from (x / z, y / z) to its distorted counterpart with slope 1 at the
/// principal point, and its inverse. Both return NaN beyond the valid radius.
struct LensFunctions {
  Eigen::Vector2d (*distort)(Coefficients k, const Eigen::Vector2d& x);
  Eigen::Vector2d (*undistort)(Coefficients k, const Eigen::Vector2d& distorted, double tolerance);
};

const LensFunctions& lens_functions(Distortion distortion);

}  // namespace gpo
