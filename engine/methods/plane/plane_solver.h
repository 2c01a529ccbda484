// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/plane/plane_motion.h"

namespace gpo {

struct PlaneSolution {
  PlaneMotion motion;
  SolverReport solver;
};

inline constexpr int kMostSteps = 300;

/// Adds zero gyroscope noise if it is an unknown, removes it otherwise.
PlaneMotion with_noise_unknowns(PlaneMotion start, const PlaneUnknowns& unknowns);

/// Minimizes the squared transfer error over the plane's normal, all scaled translations
/// (engine/method.md, eq. 7) and the other unknowns. Levenberg-Marquardt; translations and free
/// rotations are eliminated frame by frame (Schur complement), so that a step costs one pass over
/// the observations. The cost includes priors on the bias and the time offset. Fails if `start` has
/// a point behind a camera. Stops after `most_steps` that lower the cost.
PlaneSolution solve_plane(const PlaneTask& task,
                          const PlaneMotion& start,
                          const Watch& watch,
                          int most_steps = kMostSteps);

/// Finds the same minimum with Ceres, as in the paper (dogleg, dense Schur, one analytic block per
/// frame and plane); ignores weight matrices. Stops if the relative change of the cost is below the
/// tolerance.
PlaneSolution solve_plane_with_ceres(const PlaneTask& task,
                                     const PlaneMotion& start,
                                     const Watch& watch,
                                     double cost_tolerance = 1e-12);

}  // namespace gpo
