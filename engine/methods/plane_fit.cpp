// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane_fit.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_weights.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/uncertainty/shares.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace gpo {
namespace {

/// First step of the row delay [s/row]: 10 ms for 480 rows.
constexpr double kTriedRowDelay_s = 2e-5;
constexpr int kShutterRounds = 4;

/// `observations`: from the task's window, or from one corrected for a row delay.
PlaneSolution solve_once(const FitTask& task,
                         const PlaneObservations& observations,
                         const PlaneMotion& start,
                         RotationUnknowns rotations,
                         int most_steps = kMostSteps) {
  const PlaneTask plane_task{task.window,
                             observations,
                             {.rotations = rotations.model,
                              .sigma_px = task.sigma_px,
                              .gyro_noise = rotations.gyro_noise}};
  return task.options.solver == Solver::ceres
             ? solve_plane_with_ceres(plane_task, start, task.watch)
             : solve_plane(plane_task, start, task.watch, most_steps);
}

double robust_cost(const FitTask& task,
                   const PlaneSolution& solution,
                   const PlaneObservations& observations) {
  return solution.solver.final_cost +
         loss_beyond_weights(solution.motion, task.options, task.sigma_px, observations);
}

/// Solves again with another row delay but the same weights, so that the costs are comparable.
Fit refit(const FitTask& task,
          const Fit& from,
          std::span<const Velocity> velocities,
          double row_delay_s) {
  const PlaneMotion& motion = from.solution.motion;
  Fit fit{.window = without_rolling_shutter(task.window, motion, velocities, {row_delay_s}),
          .solution = {},
          .rotations = from.rotations,
          .row_delay_s = row_delay_s};
  fit.observations = plane_observations(fit.window, numbers_of(motion.others));
  copy_weights(from.observations, fit.observations);
  fit.solution = solve_once(task, fit.observations, motion, from.rotations);
  fit.cost = fit.solution.solver.final_cost;
  continue_trace(from.solution.solver, fit.solution.solver);
  return fit;
}

/// Returns the chi-square above which additional unknowns are significant.
double significant_chi_square(int more_unknowns) {
  return more_unknowns + kSignificantSigmas * std::sqrt(2.0 * more_unknowns) +
         kSignificantSigmas * kSignificantSigmas;
}

/// Returns false if one linearized step from a fit without a row delay finds it clearly
/// insignificant.
bool may_have_row_delay(const FitTask& task, const Fit& global) {
  constexpr double kFar = 0.25;
  const PlaneMotion& motion = global.solution.motion;
  const RotationModel model = global.rotations.model;
  const Window moved =
      without_rolling_shutter(task.window, motion, model, unknown_row_delay(task.window));
  const auto delay =
      multiple_of({task.window, global.observations, motion}, model, moved.row_delay_moves_px);
  return !delay || delay->chi_square > kFar * significant_chi_square(1);
}

}  // namespace

void add_effort(const SolverReport& tried, SolverReport& solver) {
  solver.milliseconds += tried.milliseconds;
  solver.iterations += tried.iterations;
}

void copy_weights(const PlaneObservations& from, PlaneObservations& to) {
  for (int k = 0; k < to.plane_count(); ++k) {
    for (std::size_t i = 0; i < to.plane(k).size(); ++i) {
      to.plane(k)[i].mask = from.plane(k)[i].mask;
      to.plane(k)[i].weight = from.plane(k)[i].weight;
    }
  }
}

bool converged(const Fit& fit) {
  return fit.solution.solver.termination == Termination::convergence;
}

int freedom(const Fit& fit) { return fit.solution.solver.residuals - fit.solution.solver.unknowns; }

double variance(const Fit& fit) {
  return 2 * fit.solution.solver.final_cost / std::max(1, freedom(fit));
}

bool is_significant(const Fit& without, const Fit& with, int more_unknowns) {
  const double chi_square = 2 * (without.cost - with.cost) / variance(with);
  return chi_square > significant_chi_square(more_unknowns);
}

Fit fit_planes(const FitTask& task,
               const PlaneMotion& start,
               RotationUnknowns rotations,
               const Rounds& rounds) {
  const Window& window = task.window;
  PlaneObservations observations = plane_observations(window, numbers_of(start.others));
  const int last = is_weighted(task.options) ? rounds.count : 0;
  PlaneSolution solution{start, {}};
  const int first = last > 0 && rounds.start_is_weighted ? 1 : 0;
  for (int round = first; round <= last; ++round) {
    if (round > 0) reweigh(solution.motion, task.options, task.sigma_px, observations);
    const int most_steps = round == 0 || round == last ? kMostSteps : 1;
    PlaneSolution next = solve_once(task, observations, solution.motion, rotations, most_steps);
    const bool settled = round > 0 && next.solver.iterations <= 1 &&
                         next.solver.termination == Termination::convergence;
    add_effort(solution.solver, next.solver);
    if (round > first) continue_trace(solution.solver, next.solver);
    solution = std::move(next);
    if (settled) break;
  }
  const double cost = robust_cost(task, solution, observations);
  return {.window = window,
          .solution = std::move(solution),
          .rotations = rotations,
          .cost = cost,
          .observations = std::move(observations)};
}

Fit with_estimated_shutter(const FitTask& task, const Fit& given) {
  if (task.options.shutter == Shutter::global || task.latent()) return given;
  if (!may_have_row_delay(task, given)) return given;
  Fit global = given;
  global.cost = given.solution.solver.final_cost;  // comparable with `refit`
  Fit best = global;
  double step_s = kTriedRowDelay_s;
  SolverReport effort = global.solution.solver;
  for (int round = 0; round < kShutterRounds && !task.watch.stop_requested(); ++round) {
    const auto velocities = velocities_of(task.window, best.solution.motion, best.rotations.model);
    const auto with = [&](double row_delay_s) {
      return refit(task, best, velocities, row_delay_s);
    };
    const Fit less = with(best.row_delay_s - step_s);
    const Fit more = with(best.row_delay_s + step_s);
    for (const Fit* each : {&less, &more}) add_effort(each->solution.solver, effort);
    const auto steps = parabola_minimum(less.cost, best.cost, more.cost);
    if (!steps) break;
    const Fit next = with(best.row_delay_s + *steps * step_s);
    add_effort(next.solution.solver, effort);
    if (!(next.cost < best.cost)) break;
    best = next;
    if (!is_significant(global, best, 1)) break;
    step_s /= 4;
  }
  Fit chosen = is_significant(global, best, 1) ? best : given;
  chosen.cost = robust_cost(task, chosen.solution, chosen.observations);
  chosen.solution.solver.milliseconds = effort.milliseconds;
  chosen.solution.solver.iterations = effort.iterations;
  return chosen;
}

}  // namespace gpo
