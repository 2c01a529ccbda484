// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "engine/methods/joint/joint_solution.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_result.h"
#include "engine/methods/plane/plane_solver.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/plane_fit.h"
#include "engine/methods/uncertainty/bend.h"
#include "engine/methods/uncertainty/uncertainty.h"

#include <cmath>
#include <limits>

namespace gpo {
namespace {

constexpr Rounds kStartRounds{2};  // for candidate starts
/// Least ratio of the noise variances that justifies free rotations for every frame. The errors of
/// a track on a real surface are the same in all frames, and free rotations explain part of them:
/// in EuRoC's room, where the bias alone is right, they lower the variance by up to a sixth. Poor
/// phone gyroscopes and the wrong one of two decompositions at least double it.
constexpr double kWorthFreeRotations = 1.25;
/// The same after one round of reweighting.
constexpr double kMayBeWorth = 1.1;

/// Returns the window with the gyroscope's rotations before its calibration from the images, which
/// may have selected the wrong one of a plane's two decompositions. nullopt without one.
std::optional<Window> with_prior_bias(const Window& window) {
  if (window.rotations != RotationModel::bias) return std::nullopt;
  const GyroSensitivity& gyro = *window.gyro;
  if (gyro.bias_rad_s == gyro.prior_rad_s) return std::nullopt;
  Window raw = window;
  PlaneMotion prior;
  prior.bias_rad_s = gyro.prior_rad_s;
  for (int i = 0; i < window.frame_count(); ++i)
    raw.R_wc[i] = window.R_wc[i] * so3_exp(gyro_correction_rad(window, i, prior));
  return raw;
}

/// Compares a fit with free rotations, in which the gyroscope no longer selects one of the plane's
/// two decompositions, with the fit from its twin.
Fit better_twin(const FitTask& task, Fit free) {
  auto other = twin_motion(task.window, free.solution.motion);
  if (!other) return free;
  if (!free.solution.motion.others.empty()) other->others = other_planes(task.window, *other);
  Fit twin = with_estimated_shutter(task, fit_planes(task, *other, {RotationModel::free}));
  const bool better = converged(twin) && variance(free) > kWorthFreeRotations * variance(twin);
  Fit& chosen = better ? twin : free;
  add_effort((better ? free : twin).solution.solver, chosen.solution.solver);
  return std::move(chosen);
}

/// A fit, and the best gyroscope bias, which a fit with free rotations does not have.
struct Best {
  Fit fit;
  Eigen::Vector3d bias_rad_s;
};

/// With a gyroscope, estimates its bias and noise, unless the images determine the rotations
/// better.
Best best_fit(const FitTask& task, const PlaneMotion& start) {
  const Window& window = task.window;
  const bool bias = window.rotations == RotationModel::bias;
  // No choice depends on the cost if the joint model follows with the same unknowns.
  const Rounds rounds{task.latent() && !bias ? 1 : Rounds{}.count, true};
  const bool noisy = bias && window.gyro->noise_density > 0;
  Fit fit =
      with_estimated_shutter(task, fit_planes(task, start, {window.rotations, noisy}, rounds));
  const Eigen::Vector3d bias_rad_s = fit.solution.motion.bias_rad_s;
  if (!bias) return {std::move(fit), bias_rad_s};
  Fit free = fit_planes(task, fit.solution.motion, {RotationModel::free}, {1, true});
  if (fit.row_delay_s != 0 || variance(fit) > kMayBeWorth * variance(free)) {
    const SolverReport first = free.solution.solver;
    free = with_estimated_shutter(
        task, fit_planes(task, free.solution.motion, {RotationModel::free}, rounds));
    add_effort(first, free.solution.solver);
    const int more = freedom(fit) - freedom(free);
    if (is_significant(fit, free, more) && variance(fit) > kWorthFreeRotations * variance(free)) {
      add_effort(fit.solution.solver, free.solution.solver);
      return {better_twin(task, std::move(free)), bias_rad_s};
    }
  }
  add_effort(free.solution.solver, fit.solution.solver);
  return {std::move(fit), bias_rad_s};
}

/// Optimizes a start with the main plane, then with all planes if requested.
Fit optimized(const FitTask& task, const PlaneMotion& start, SolverReport& effort) {
  Fit fit = fit_planes(task, start, {task.window.rotations}, kStartRounds);
  add_effort(fit.solution.solver, effort);
  if (task.options.planes == Planes::one || task.window.planes.size() < 2 || !converged(fit))
    return fit;
  PlaneMotion with_others = fit.solution.motion;
  with_others.others = other_planes(task.window, with_others);
  if (with_others.others.empty()) return fit;
  Fit all = fit_planes(task, with_others, {task.window.rotations}, kStartRounds);
  add_effort(all.solution.solver, effort);
  return converged(all) ? all : fit;
}

/// Returns the cost per residual, comparable between different numbers of planes.
double mean_cost(const Fit& fit) {
  return converged(fit) ? fit.cost / std::max(1, fit.solution.solver.residuals)
                        : std::numeric_limits<double>::infinity();
}

/// Returns the best of several starts: GPO with the given rotations; GPO with the gyroscope's
/// rotations before calibration; for several planes without a gyroscope also the twin, which fits
/// the main plane equally well but not the others.
PlaneMotion best_start(const FitTask& task, SolverReport& effort) {
  std::vector<PlaneMotion> starts;
  const auto add_gpo = [&](const Window& window) {
    const PlaneSolution gpo = solve_gpo(window, {}, task.watch);
    add_effort(gpo.solver, effort);
    starts.push_back(facing(window, gpo.motion));
  };
  add_gpo(task.window);
  if (const auto raw = with_prior_bias(task.window)) {
    add_gpo(*raw);
    starts.back().bias_rad_s = task.window.gyro->prior_rad_s;
  }
  const bool several = task.options.planes == Planes::all && task.window.planes.size() > 1;
  if (several && task.window.rotations == RotationModel::free) {
    if (const auto twin = twin_motion(task.window, starts.front())) starts.push_back(*twin);
  }
  PlaneMotion best = starts.front();
  double least = std::numeric_limits<double>::infinity();
  for (const PlaneMotion& start : starts) {
    const Fit next = optimized(task, start, effort);
    const double cost = mean_cost(next);
    if (cost < least) best = next.solution.motion;
    least = std::min(least, cost);
  }
  return best;
}

joint::Options joint_options(const FitTask& task, const RotationUnknowns& rotations) {
  joint::Options options{.rotations = rotations.model,
                         .gyro_noise = rotations.gyro_noise,
                         .row_delay = std::nullopt,
                         .huber = task.options.loss == Loss::huber};
  if (task.options.shutter != Shutter::global) options.row_delay = unknown_row_delay(task.window);
  if (task.options.shutter == Shutter::known && task.window.row_delay)
    options.row_delay = task.window.row_delay;
  return options;
}

/// Returns the solution of the joint model that starts at a fit. With free rotations the plane's
/// other decomposition may fit as well.
std::optional<joint::Solution> solve_jointly(const FitTask& task, const Fit& fit) {
  const joint::Options options = joint_options(task, fit.rotations);
  const PlaneMotion start = facing(task.window, fit.solution.motion);
  auto solution = joint::solve(task.window, start, options, task.watch);
  const bool has_twin = fit.rotations.model == RotationModel::free && start.others.empty();
  if (!solution || !has_twin) return solution;
  const auto twin = twin_motion(task.window, solution->motion);
  if (!twin) return solution;
  const joint::Rival rival{solution->solver.final_cost, kWorthFreeRotations};
  auto other = joint::solve(task.window, *twin, options, task.watch, rival);
  return other ? better_of_twins(std::move(*solution), std::move(*other)) : solution;
}

/// Continues a fit by the solution of the joint model, with the points as its cameras see them. The
/// fit has the row delay if it is significant; the points are moved by it in any case.
void take(const joint::Solution& joint, const Window& window, Fit& fit) {
  SolverReport solver = joint.solver;
  add_effort(fit.solution.solver, solver);
  continue_trace(fit.solution.solver, solver);
  fit.solution = {joint.motion, std::move(solver)};
  const double sigma_s = joint.uncertainty.row_delay_sigma_s.value_or(0);
  const bool significant = std::abs(joint.row_delay_s) > kSignificantSigmas * sigma_s;
  fit.row_delay_s = significant ? joint.row_delay_s : 0;
  fit.window = joint.lens_residual ? without_lens_residual(window, *joint.lens_residual) : window;
  if (joint.row_delay_s != 0)
    fit.window =
        without_rolling_shutter(fit.window, joint.motion, fit.rotations.model, {joint.row_delay_s});
  PlaneObservations moved = plane_observations(fit.window, numbers_of(joint.motion.others));
  copy_weights(fit.observations, moved);
  fit.observations = std::move(moved);
}

void set_time_offset(const Window& window, double correction_s, Initialization& result) {
  result.time_offset_correction_s = correction_s;
  result.time_offset_s = window.gyro->time_offset_s + correction_s;
}

/// Returns the result for the window corrected for its own `row_delay`, whose standard deviation
/// adds to all uncertainties.
Initialization initialize_at_row_delay(const Window& window,
                                       const MethodOptions& options,
                                       const Watch& watch) {
  constexpr int kCorrections = 2;  // the correction depends on the motion, and vice versa
  const RowDelayPrior& delay = *window.row_delay;
  MethodOptions global = options;
  global.shutter = Shutter::global;
  if (delay.mean_s == 0 && delay.sigma_s == 0) return initialize_gpo_joint(window, global, watch);
  PlaneMotion motion = facing(window, solve_gpo(window, {}, watch).motion);
  if (options.planes == Planes::all && window.planes.size() > 1)
    motion.others = other_planes(window, motion);
  RotationModel rotations = window.rotations;
  Initialization result;
  for (int round = 0; round < kCorrections; ++round) {
    Window corrected = without_rolling_shutter(window, motion, rotations, delay);
    refine_homographies(corrected);
    Initialization next = initialize_gpo_joint(corrected, global, watch);
    add_effort(result.solver, next.solver);
    result = std::move(next);
    if (!result.ok) return result;
    motion = motion_of(result);
    if (result.uncertainty) rotations = result.uncertainty->rotations;
  }
  if (delay.mean_s != 0) result.row_delay_s = delay.mean_s;
  if (result.uncertainty) result.uncertainty->row_delay_sigma_s = delay.sigma_s;
  return result;
}

/// Returns the window with exact clocks if the options say so.
Window with_clock(Window window, const MethodOptions& options) {
  if (!options.time_offset && window.gyro) window.gyro->time_offset_sigma_s = 0;
  return window;
}

/// Returns the bend of the surface, which the lens residual of the joint model would explain.
std::optional<double> bend_beside(const Window& window,
                                  const Fit& fit,
                                  const PlaneMotion& motion,
                                  double sigma_px) {
  Window bent = window;
  if (fit.row_delay_s != 0)
    bent = without_rolling_shutter(window, motion, fit.rotations.model, {fit.row_delay_s});
  PlaneObservations observations = plane_observations(bent, numbers_of(motion.others));
  copy_weights(fit.observations, observations);
  return bend_sigma_deg({bent, observations, motion}, sigma_px);
}

double sigma_px_of(const Window& window) { return homography_error_px(window) / kMedianOfRayleigh; }

}  // namespace

Initialization restart_gpo_joint(const Window& given,
                                 const Initialization& start,
                                 const MethodOptions& options,
                                 const Watch& watch) {
  Window window = with_clock(given, options);
  PlaneMotion motion = motion_of(start);
  const RotationModel model = start.uncertainty ? start.uncertainty->rotations : window.rotations;
  if (model == RotationModel::bias) motion.bias_rad_s = *start.bias_rad_s;
  motion.time_offset_correction_s = start.time_offset_correction_s.value_or(0);
  const RotationUnknowns rotations{model,
                                   model == RotationModel::bias && window.gyro->noise_density > 0};
  const FitTask of_all{window, options, sigma_px_of(window), watch};
  const double row_delay_s = start.row_delay_s.value_or(0);
  const auto result_of = [&](const PlaneMotion& end) {
    RefusedSolution solution = solution_of(facing(window, end));
    Initialization result;
    result.ok = true;
    result.plane = solution.plane;
    result.cameras = std::move(solution.cameras);
    return result;
  };
  if (of_all.latent(row_delay_s)) {
    joint::Options of_joint = joint_options(of_all, rotations);
    of_joint.uncertainty = false;
    const auto joint = joint::solve(window, facing(window, motion), of_joint, watch);
    return joint ? result_of(joint->motion) : failed("not determined");
  }
  if (row_delay_s != 0) window = without_rolling_shutter(window, motion, model, {row_delay_s});
  const Fit fit = fit_planes(
      {window, options, of_all.sigma_px, watch}, motion, rotations, {Rounds{}.count, true});
  return converged(fit) ? result_of(fit.solution.motion) : not_converged(fit.solution.solver);
}

Initialization initialize_gpo_joint(const Window& given,
                                    const MethodOptions& options,
                                    const Watch& watch) {
  const Window window = with_clock(given, options);
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  const FitTask task{window, options, sigma_px_of(window), watch};
  if (options.shutter == Shutter::known && window.row_delay && !task.latent())
    return initialize_at_row_delay(window, options, watch);
  SolverReport effort;
  const PlaneMotion start = best_start(task, effort);
  auto [fit, bias_rad_s] = best_fit(task, start);
  SolverReport& solver = fit.solution.solver;
  solver.milliseconds += effort.milliseconds;
  if (solver.termination != Termination::convergence) return not_converged(solver);
  fit.solution.motion.bias_rad_s = bias_rad_s;
  auto joint = task.latent(fit.row_delay_s) ? solve_jointly(task, fit) : std::nullopt;
  const bool chosen = options.error == ErrorModel::automatic;
  if (chosen && joint && joint->solver.termination != Termination::convergence) joint.reset();
  if (options.error == ErrorModel::latent && !joint)
    return watch.stop_requested() ? stopped_early()
                                  : failed(
                                        "no solution of the joint model: a point is behind a "
                                        "camera, or the window is too weak",
                                        solver);
  if (joint) take(*joint, window, fit);
  if (solver.termination != Termination::convergence) return not_converged(solver);
  if (fit.rotations.model == RotationModel::bias) bias_rad_s = fit.solution.motion.bias_rad_s;
  Initialization result = make_result(fit.window, fit.solution.motion, solver);
  if (!result.ok) return result;
  const PlaneMotion motion = facing(fit.window, fit.solution.motion);
  result.uncertainty =
      joint ? std::optional(joint->uncertainty)
            : uncertainty_of({fit.window, fit.observations, motion}, fit.rotations.model);
  if (joint)
    result.uncertainty->bend_sigma_deg =
        bend_beside(window, fit, motion, result.uncertainty->sigma_px);
  set_plane_uncertainties(result);
  if (window.rotations == RotationModel::bias) result.bias_rad_s = bias_rad_s;
  if (gyro_unknowns(window, fit.rotations.model) > 3)
    set_time_offset(window, fit.solution.motion.time_offset_correction_s, result);
  if (fit.row_delay_s != 0) result.row_delay_s = fit.row_delay_s;
  if (joint) result.lens_residual = joint->lens_residual;
  if (joint && joint->other) result.other_minimum = solution_of(facing(fit.window, *joint->other));
  return result;
}

}  // namespace gpo
