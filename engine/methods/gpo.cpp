// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_result.h"

namespace gpo {

PlaneSolution solve_gpo(const Window& window, const MethodOptions& options, const Watch& watch) {
  const PlaneObservations observations = plane_observations(window);
  if (options.solver == Solver::ceres)
    return solve_plane_with_ceres(
        {window, observations, {}}, motion_without_translation(window), watch);
  if (const auto closed = closed_form_motion(window)) {
    PlaneSolution solution = solve_plane({window, observations, {}}, *closed, watch);
    if (solution.solver.termination != Termination::failure) return solution;
  }
  return solve_plane({window, observations, {}}, motion_without_translation(window), watch);
}

Initialization initialize_gpo(const Window& window,
                              const MethodOptions& options,
                              const Watch& watch) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  const auto [motion, solver] = solve_gpo(window, options, watch);
  if (solver.termination != Termination::convergence) return not_converged(solver);
  return make_result(window, motion, solver);
}

Initialization initialize_closed_form(const Window& window, const Watch& /*watch*/) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  auto motion = closed_form_motion(window);
  if (!motion) return failed("a frame has no homography");
  for (int i = 1; i < window.frame_count(); ++i)
    motion->tau[i] = translation_given_normal(window, i, motion->normal);
  return make_result(window, *motion, {});
}

}  // namespace gpo
