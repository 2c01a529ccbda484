// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/gpo_joint.h"

#include "engine/geometry/statistics.h"
#include "engine/initializers/certainty/uncertainty.h"
#include "engine/initializers/common/window_checks.h"
#include "engine/initializers/gpo.h"
#include "engine/initializers/plane/delivery.h"
#include "engine/initializers/plane/plane_solver.h"
#include "engine/initializers/plane/plane_weights.h"
#include "engine/initializers/plane/rolling_shutter.h"

#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Rounds of reweighting, each a solve from the last one.
constexpr int kWeightRounds = 10;
/// More unknowns must lower the cost so much: chi-square of what noise alone does, 4 sigma.
constexpr double kSignificantSigmas = 4;
/// The pace that is tried first [s/row]: 10 ms for 480 rows.
constexpr double kTriedRowDelay_s = 2e-5;
constexpr int kShutterRounds = 4;
/// A bias so many prior standard deviations out is none.
constexpr double kMostBiasSigmas = 6;

/// A solution, and the window as the shutter that goes with it would have seen it.
struct Fit {
  Window window;
  PlaneSolution solution;
  RotationModel rotations;
  double row_delay_s = 0;

  double cost() const { return solution.solver.final_cost; }
};

struct Task {
  const Window& window;
  const InitializerOptions& options;
  double sigma_px;
  const Watch& watch;
};

PlaneSolution solve(const Task& task,
                    const Window& window,
                    const PlaneMotion& start,
                    RotationModel rotations) {
  const bool offset = task.options.time_offset && rotations == RotationModel::bias;
  const PlaneUnknowns unknowns{rotations, offset, task.sigma_px};
  if (task.options.solver == Solver::ceres)
    return solve_plane_with_ceres(window, start, unknowns, task.watch);
  PlaneObservations observations = plane_observations(window);
  PlaneSolution solution = solve_plane(window, observations, start, unknowns, task.watch);
  for (int round = 0; is_weighted(task.options) && round < kWeightRounds; ++round) {
    reweigh(solution.motion, task.options, task.sigma_px, observations);
    PlaneSolution next = solve_plane(window, observations, solution.motion, unknowns, task.watch);
    next.solver.iterations += solution.solver.iterations;
    next.solver.milliseconds += solution.solver.milliseconds;
    continue_trace(solution.solver, next.solver);
    const bool settled = next.solver.iterations <= solution.solver.iterations + 1;
    solution = std::move(next);
    if (settled) break;
  }
  return solution;
}

/// The fit with another pace of the rows, from a fit at hand; time and iterations add up.
Fit refit(const Task& task, const Fit& from, double row_delay_s) {
  Fit fit{without_rolling_shutter(task.window, from.solution.motion, row_delay_s),
          {},
          from.rotations,
          row_delay_s};
  fit.solution = solve(task, fit.window, from.solution.motion, from.rotations);
  continue_trace(from.solution.solver, fit.solution.solver);
  return fit;
}

/// Whether so many more unknowns explain more than noise: `fit` leaves what noise there is.
bool is_significant(const Fit& without, const Fit& with, int more_unknowns) {
  const SolverReport& s = with.solution.solver;
  const double variance = 2 * s.final_cost / std::max(1, s.residuals - s.unknowns);
  const double chi_square = 2 * (without.cost() - s.final_cost) / variance;
  return chi_square > more_unknowns + kSignificantSigmas * std::sqrt(2.0 * more_unknowns) +
                          kSignificantSigmas * kSignificantSigmas;
}

/// The pace at the minimum of a parabola through the costs at three, in rounds.
Fit with_estimated_shutter(const Task& task, const Fit& global) {
  Fit best = global;
  double step_s = kTriedRowDelay_s;
  double milliseconds = global.solution.solver.milliseconds;
  int iterations = global.solution.solver.iterations;
  for (int round = 0; round < kShutterRounds && !task.watch.stop_requested(); ++round) {
    const Fit less = refit(task, best, best.row_delay_s - step_s);
    const Fit more = refit(task, best, best.row_delay_s + step_s);
    const double bend = more.cost() - 2 * best.cost() + less.cost();
    const double move_s = 0.5 * step_s * (less.cost() - more.cost()) / bend;
    const Fit next = refit(task, best, best.row_delay_s + move_s);
    for (const Fit* each : {&less, &more, &next}) {
      milliseconds += each->solution.solver.milliseconds;
      iterations += each->solution.solver.iterations;
    }
    if (!(bend > 0) || !(next.cost() < best.cost())) break;
    best = next;
    if (!is_significant(global, best, 1)) break;
    step_s /= 4;
  }
  Fit chosen = is_significant(global, best, 1) ? best : global;
  chosen.solution.solver.milliseconds = milliseconds;
  chosen.solution.solver.iterations = iterations;
  return chosen;
}

Fit fitted(const Task& task, const PlaneMotion& start, RotationModel rotations) {
  const Fit global{task.window, solve(task, task.window, start, rotations), rotations};
  return task.options.shutter == Shutter::estimated ? with_estimated_shutter(task, global) : global;
}

/// With a gyroscope, the bias alone, unless the pictures know the rotations better than it does.
Fit best_fit(const Task& task, const PlaneMotion& start) {
  Fit fit = fitted(task, start, task.window.rotations);
  if (fit.rotations != RotationModel::bias) return fit;
  Fit free = fitted(task, fit.solution.motion, RotationModel::free);
  const int more = free.solution.solver.unknowns - fit.solution.solver.unknowns;
  const bool better = is_significant(fit, free, more);
  Fit& chosen = better ? free : fit;
  const Fit& other = better ? fit : free;
  chosen.solution.solver.milliseconds += other.solution.solver.milliseconds;
  chosen.solution.solver.iterations += other.solution.solver.iterations;
  return chosen;
}

std::string why_wrong(const Window& window, const PlaneMotion& motion) {
  if (window.rotations != RotationModel::bias) return "";
  const GyroSensitivity& gyro = *window.gyro;
  const double sigmas = (motion.bias_rad_s - gyro.prior_rad_s).norm() / gyro.prior_sigma_rad_s;
  if (sigmas < kMostBiasSigmas) return "";
  return fmt::format(
      "wrong minimum: a gyroscope bias of {:.3f} rad/s fits best, {:.0f} standard "
      "deviations from what is known of it",
      motion.bias_rad_s.norm(),
      sigmas);
}

}  // namespace

Initialization initialize_gpo_joint(const Window& window,
                                    const InitializerOptions& options,
                                    const Watch& watch) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  const Task task{window, options, homography_error_px(window) / kMedianOfRayleigh, watch};
  const PlaneSolution start = solve_gpo(window, {}, watch);
  Fit fit = best_fit(task, facing(window, start.motion));
  SolverReport& solver = fit.solution.solver;
  solver.milliseconds += start.solver.milliseconds;
  if (solver.termination != Termination::convergence) return not_converged(solver);
  if (const std::string wrong = why_wrong(window, fit.solution.motion); !wrong.empty())
    return failed(wrong, solver);
  Initialization result = deliver(fit.window, fit.solution.motion, solver);
  if (!result.ok) return result;
  result.uncertainty = uncertainty_of(fit.window, result.plane, result.cameras, fit.rotations);
  if (fit.rotations == RotationModel::bias) {
    result.bias_rad_s = fit.solution.motion.bias_rad_s;
    if (options.time_offset) result.time_offset_s = fit.solution.motion.time_offset_s;
  }
  if (fit.row_delay_s != 0) result.row_delay_s = fit.row_delay_s;
  return result;
}

}  // namespace gpo
