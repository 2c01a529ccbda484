// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/plane/delivery.h"

#include "engine/initializers/common/map_points.h"
#include "engine/initializers/common/window_checks.h"

namespace gpo {
namespace {

/// The other one of the two solutions with the same pictures.
void turn_normals(SolverReport& solver) {
  for (SolverStep& step : solver.trace) {
    if (step.normal) step.normal = -*step.normal;
  }
}

}  // namespace

Initialization deliver(const Window& window,
                       const PlaneMotion& motion,
                       const SolverReport& solver) {
  const PlaneMotion visible = facing(window, motion);
  Initialization result;
  result.solver = solver;
  if (visible.normal.dot(motion.normal) < 0) turn_normals(result.solver);
  result.plane = {visible.normal, 1};
  result.cameras = cameras_of(visible);
  if (auto reason = reason_to_distrust(window, result.plane, result.cameras))
    return failed(*reason, result.solver);
  result.points = lift_to_plane(window, result.plane, result.cameras);
  result.rms_px = root_mean_square(reprojection_errors_px(window, result.plane, result.cameras));
  result.ok = true;
  return result;
}

}  // namespace gpo
