// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/known_shutter.h"

#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/rolling_shutter.h"

namespace gpo {
namespace {

/// The correction depends on the motion, and the motion on the correction.
constexpr int kCorrections = 2;

PlaneMotion first_motion(const Window& window, const MethodOptions& options, const Watch& watch) {
  PlaneMotion motion = facing(window, solve_gpo(window, {}, watch).motion);
  if (options.planes == Planes::all && window.planes.size() > 1)
    motion.others = other_planes(window, motion);
  return motion;
}

PlaneMotion motion_of(const Initialization& result) {
  PlaneMotion motion = gpo::motion_of(result.plane, result.cameras);
  for (std::size_t k = 1; k < result.planes.size(); ++k) {
    const auto& [normal, distance] = result.planes[k].plane;
    motion.others.push_back({result.planes[k].number, normal / distance});
  }
  return motion;
}

}  // namespace

Initialization initialize_at_row_delay(const Window& window,
                                       const MethodOptions& options,
                                       const Watch& watch) {
  const RowDelayPrior& delay = *window.row_delay;
  MethodOptions global = options;
  global.shutter = Shutter::global;
  if (delay.mean_s == 0 && delay.sigma_s == 0) return initialize_gpo_joint(window, global, watch);
  PlaneMotion motion = first_motion(window, options, watch);
  RotationModel rotations = window.rotations;
  Initialization result;
  for (int round = 0; round < kCorrections; ++round) {
    Window corrected = without_rolling_shutter(window, motion, rotations, delay);
    refine_homographies(corrected);
    Initialization next = initialize_gpo_joint(corrected, global, watch);
    next.solver.milliseconds += result.solver.milliseconds;
    next.solver.iterations += result.solver.iterations;
    result = std::move(next);
    if (!result.ok) return result;
    motion = motion_of(result);
    if (result.uncertainty) rotations = result.uncertainty->rotations;
  }
  if (delay.mean_s != 0) result.row_delay_s = delay.mean_s;
  if (result.uncertainty) result.uncertainty->row_delay_sigma_s = delay.sigma_s;
  return result;
}

}  // namespace gpo
