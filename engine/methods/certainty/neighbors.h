// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/certainty/sandwich.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Returns the part of the normals' covariance that comes from errors which neighboring tracks
/// share (lens model, rolling shutter, curved surface). The normal absorbs them, so that little is
/// left in the residuals; a jackknife over image regions measures them (engine/method.md, eq. 14e).
/// One per plane, over its tangents, in excess of `noise` [rad^2]; nullopt if not significant, with
/// too few tracks, if a region less leaves the normal undetermined, or away from the solution.
/// `noise`: covariance of the shared unknowns by (14b); `sigma_px` noise of a coordinate.
std::vector<std::optional<Eigen::Matrix2d>> neighbors_spread(const SolvedPlanes& solved,
                                                             RotationModel model,
                                                             double sigma_px,
                                                             const SharedMatrix& noise);

}  // namespace gpo
