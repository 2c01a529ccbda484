// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/certainty/sandwich.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// What tracks near one another have wrong together (a lens that is not quite its model, a shutter
/// that rolls, a surface that bends) the normal takes up: the residuals keep little of it, so sums
/// over tracks promise too much. How far each normal moves when a quarter of the picture is left
/// out knows (jackknife; engine/method.md, eq. 14e). One a plane, over its tangents [rad^2];
/// nothing where tracks that are independent would move it as far, where they are too few, where a
/// quarter less leaves it undetermined, or away from the solution. `noise`: covariance of what the
/// frames share, by (14b); `sigma_px` of a coordinate.
std::vector<std::optional<Eigen::Matrix2d>> neighbors_spread(const Window& window,
                                                             const PlaneObservations& observations,
                                                             const PlaneMotion& motion,
                                                             RotationModel model,
                                                             double sigma_px,
                                                             const SharedMatrix& noise);

}  // namespace gpo
