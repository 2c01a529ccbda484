// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initializers/common/initialization.h"
#include "engine/initializers/common/watch.h"
#include "engine/initializers/plane/plane_motion.h"
#include "engine/initializers/plane/plane_observations.h"
#include "engine/window/window.h"

#include <vector>

namespace gpo {

/// What is optimized beside the normal and the translations.
struct PlaneUnknowns {
  /// bias: needs the window's `gyro`. free: three more unknowns a frame.
  RotationModel rotations = RotationModel::known;
  bool time_offset = false;  ///< with `bias`: the offset between the clocks, too
  double sigma_px = 0.5;     ///< noise of a coordinate, against which the priors are weighed
};

/// Standard deviation of the offset between clocks before anything is measured [s].
inline constexpr double kTimeOffsetSigma_s = 0.02;

struct PlaneSolution {
  PlaneMotion motion;
  SolverReport solver;
};

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
