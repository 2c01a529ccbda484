// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_observations.h"
#include "engine/methods/plane/shared_unknowns.h"
#include "engine/window/window.h"

namespace gpo {

struct PlaneSolution {
  PlaneMotion motion;
  SolverReport solver;
};

/// With a noise of the gyroscope where it is an unknown, and nowhere else.
PlaneMotion started(PlaneMotion start, const PlaneUnknowns& unknowns);

/// Least squared transfer error over the plane's normal, all scaled translations (engine/method.md,
/// eq. 7) and what else is unknown. Levenberg-Marquardt; translations and free rotations are
/// eliminated frame by frame (Schur complement), so that a step costs one pass over the
/// observations. Priors on the bias and the time offset count in the cost. `start` with a point
/// behind a camera makes it fail.
PlaneSolution solve_plane(const Window& window,
                          const PlaneObservations& observations,
                          const PlaneMotion& start,
                          const PlaneUnknowns& unknowns,
                          const Watch& watch);

/// The same minimum by Ceres, as the paper does it (dogleg, dense Schur, one analytic block a
/// frame and plane); weights that are matrices are taken as one. It ends where the cost changes
/// relatively less than the tolerance.
PlaneSolution solve_plane_with_ceres(const Window& window,
                                     const PlaneObservations& observations,
                                     const PlaneMotion& start,
                                     const PlaneUnknowns& unknowns,
                                     const Watch& watch,
                                     double cost_tolerance = 1e-12);

}  // namespace gpo
