// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/gpo_joint.h"

#include "engine/initializers/delivery.h"
#include "engine/initializers/gpo.h"
#include "engine/initializers/plane_solver.h"
#include "engine/initializers/window_checks.h"

#include <fmt/format.h>

namespace gpo {
namespace {

/// The median length of a two-dimensional error of unit variance in each coordinate (Rayleigh).
constexpr double kMedianOfRayleigh = 1.1774;

}  // namespace

Initialization initialize_gpo_joint(const Window& window,
                                    const InitializerOptions& options,
                                    const std::stop_token& stop) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  const double sigma_px = homography_error_px(window) / kMedianOfRayleigh;
  const PlaneMotion start = facing(window, solve_gpo(window, {}, stop).motion);
  const PlaneUnknowns unknowns{window.rotations, options.time_offset, sigma_px};
  const auto [motion, solver] =
      options.solver == Solver::ceres
          ? solve_plane_with_ceres(window, start, unknowns, stop)
          : solve_plane(window, plane_observations(window), start, unknowns, stop);
  if (solver.termination != "convergence") {
    return failed(fmt::format("no convergence after {} iterations", solver.iterations), solver);
  }
  Initialization result = deliver(window, motion, solver);
  if (window.rotations == RotationModel::bias) {
    result.bias_rad_s = motion.bias_rad_s;
    if (options.time_offset) result.time_offset_s = motion.time_offset_s;
  }
  return result;
}

}  // namespace gpo
