// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/gpo_joint.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/certainty/uncertainty.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/gpo.h"
#include "engine/methods/plane/plane_result.h"
#include "engine/methods/plane/other_planes.h"
#include "engine/methods/plane/other_decomposition.h"
#include "engine/methods/plane/plane_solver.h"
#include "engine/methods/plane/plane_weights.h"
#include "engine/methods/plane/rolling_shutter.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Rounds of reweighting, each a solve from the last one.
constexpr int kWeightRounds = 10;
constexpr int kStartRounds = 2;  // of a start, which is to be compared and is solved for again
/// More unknowns must lower the cost so much: chi-square of what noise alone does, 4 sigma.
constexpr double kSignificantSigmas = 4;
/// Rotations of their own for every frame must lower the noise so much, too: what is wrong with a
/// track on a real surface is the same in all frames, and such unknowns explain some of it. In
/// EuRoC's room, where the bias alone is right, they lower its variance by up to a sixth; bad
/// gyroscopes of phones leave twice as much and more. The wrong one of two readings leaves more,
/// too.
constexpr double kWorthFreeRotations = 1.25;
/// The pace that is tried first [s/row]: 10 ms for 480 rows.
constexpr double kTriedRowDelay_s = 2e-5;
constexpr int kShutterRounds = 4;
/// No gyroscope has a larger bias; nor one that is so many standard deviations out, of those that
/// its file tells.
constexpr double kMostBias_rad_s = 0.5;
constexpr double kMostBiasSigmas = 6;

/// What is unknown of the rotations.
struct Turns {
  RotationModel model = RotationModel::known;
  bool gyro_noise = false;
};

/// A solution, and the window as the shutter that goes with it would have seen it.
struct Fit {
  Window window;
  PlaneSolution solution;
  Turns turns;
  double row_delay_s = 0;
  double cost = 0;  ///< as the loss has it, which solutions with different weights share [px^2]
  PlaneObservations observations = {};  ///< of this window, with the weights of the last round
};

struct Task {
  const Window& window;
  const MethodOptions& options;
  double sigma_px;
  const Watch& watch;
};

PlaneSolution solve_once(const Task& task,
                         const Window& window,
                         const PlaneObservations& observations,
                         const PlaneMotion& start,
                         Turns turns) {
  const bool offset = task.options.time_offset && turns.model == RotationModel::bias;
  const PlaneUnknowns unknowns{turns.model, offset, task.sigma_px, turns.gyro_noise};
  return task.options.solver == Solver::ceres
             ? solve_plane_with_ceres(window, observations, start, unknowns, task.watch)
             : solve_plane(window, observations, start, unknowns, task.watch);
}

Fit solve(const Task& task, const PlaneMotion& start, Turns turns, int rounds = kWeightRounds) {
  const Window& window = task.window;
  PlaneObservations observations = plane_observations(window, numbers_of(start.others));
  const auto solve_from = [&](const PlaneMotion& from) {
    return solve_once(task, window, observations, from, turns);
  };
  PlaneSolution solution = solve_from(start);
  for (int round = 0; is_weighted(task.options) && round < rounds; ++round) {
    reweigh(solution.motion, task.options, task.sigma_px, observations);
    PlaneSolution next = solve_from(solution.motion);
    next.solver.iterations += solution.solver.iterations;
    next.solver.milliseconds += solution.solver.milliseconds;
    continue_trace(solution.solver, next.solver);
    const bool settled = next.solver.iterations <= solution.solver.iterations + 1;
    solution = std::move(next);
    if (settled) break;
  }
  const double cost =
      solution.solver.final_cost +
      loss_beyond_weights(solution.motion, task.options, task.sigma_px, observations);
  return {window, std::move(solution), turns, 0, cost, std::move(observations)};
}

/// The weights of one fit for the same observations in another one.
void copy_weights(const PlaneObservations& from, PlaneObservations& to) {
  const auto copy = [](const std::vector<FrameObservations>& a, std::vector<FrameObservations>& b) {
    for (std::size_t i = 0; i < b.size(); ++i) {
      b[i].mask = a[i].mask;
      b[i].weight = a[i].weight;
    }
  };
  copy(from.frames, to.frames);
  for (std::size_t k = 0; k < to.others.size(); ++k) copy(from.others[k], to.others[k]);
}

/// The fit with another pace of the rows, from a fit at hand, whose weights it keeps, so that their
/// costs compare to the last digit; time and iterations add up.
Fit refit(const Task& task, const Fit& from, double row_delay_s) {
  const PlaneMotion& motion = from.solution.motion;
  Fit fit{without_rolling_shutter(task.window, motion, row_delay_s), {}, from.turns, row_delay_s};
  fit.observations = plane_observations(fit.window, numbers_of(motion.others));
  copy_weights(from.observations, fit.observations);
  fit.solution = solve_once(task, fit.window, fit.observations, motion, from.turns);
  fit.cost = fit.solution.solver.final_cost;
  continue_trace(from.solution.solver, fit.solution.solver);
  return fit;
}

bool converged(const Fit& fit) {
  return fit.solution.solver.termination == Termination::convergence;
}

int freedom(const Fit& fit) { return fit.solution.solver.residuals - fit.solution.solver.unknowns; }

/// Of a coordinate's noise, as the residuals tell it [px^2].
double variance(const Fit& fit) {
  return 2 * fit.solution.solver.final_cost / std::max(1, freedom(fit));
}

/// Whether so many more unknowns explain more than noise: `fit` leaves what noise there is.
bool is_significant(const Fit& without, const Fit& with, int more_unknowns) {
  const double chi_square = 2 * (without.cost - with.cost) / variance(with);
  return chi_square > more_unknowns + kSignificantSigmas * std::sqrt(2.0 * more_unknowns) +
                          kSignificantSigmas * kSignificantSigmas;
}

/// Adds time and iterations of what was tried beside it.
void add_effort(const SolverReport& tried, SolverReport& solver) {
  solver.milliseconds += tried.milliseconds;
  solver.iterations += tried.iterations;
}

/// The pace at the minimum of a parabola through the costs at three, in rounds.
Fit with_estimated_shutter(const Task& task, const Fit& given) {
  Fit global = given;
  global.cost = given.solution.solver.final_cost;  // as its weights have it, like the others'
  Fit best = global;
  double step_s = kTriedRowDelay_s;
  SolverReport effort = global.solution.solver;
  for (int round = 0; round < kShutterRounds && !task.watch.stop_requested(); ++round) {
    const Fit less = refit(task, best, best.row_delay_s - step_s);
    const Fit more = refit(task, best, best.row_delay_s + step_s);
    const double bend = more.cost - 2 * best.cost + less.cost;
    const double move_s = 0.5 * step_s * (less.cost - more.cost) / bend;
    const Fit next = refit(task, best, best.row_delay_s + move_s);
    for (const Fit* each : {&less, &more, &next}) add_effort(each->solution.solver, effort);
    if (!(bend > 0) || !(next.cost < best.cost)) break;
    best = next;
    if (!is_significant(global, best, 1)) break;
    step_s /= 4;
  }
  Fit chosen = is_significant(global, best, 1) ? best : given;
  chosen.cost =
      chosen.solution.solver.final_cost +
      loss_beyond_weights(chosen.solution.motion, task.options, task.sigma_px, chosen.observations);
  chosen.solution.solver.milliseconds = effort.milliseconds;
  chosen.solution.solver.iterations = effort.iterations;
  return chosen;
}

Fit fitted(const Task& task, const PlaneMotion& start, Turns turns) {
  const Fit global = solve(task, start, turns);
  return task.options.shutter == Shutter::estimated ? with_estimated_shutter(task, global) : global;
}

/// Rotations of their own take up what a gyroscope tells of a plane's two readings; then the
/// pictures must.
Fit better_reading(const Task& task, Fit free) {
  auto other = other_decomposition(task.window, free.solution.motion);
  if (!other) return free;
  if (!free.solution.motion.others.empty()) other->others = other_planes(task.window, *other);
  Fit twin = fitted(task, *other, {RotationModel::free});
  const bool better = converged(twin) && variance(free) > kWorthFreeRotations * variance(twin);
  Fit& chosen = better ? twin : free;
  add_effort((better ? free : twin).solution.solver, chosen.solution.solver);
  return std::move(chosen);
}

/// A fit, and the gyroscope's bias that fits best where it is not the fit's own.
struct Best {
  Fit fit;
  Eigen::Vector3d bias_rad_s;
};

/// With a gyroscope, its bias and its noise, unless the pictures know the rotations better than so
/// good a gyroscope does.
Best best_fit(const Task& task, const PlaneMotion& start) {
  const Window& window = task.window;
  const bool noisy = window.rotations == RotationModel::bias && window.gyro->noise_density > 0;
  Fit fit = fitted(task, start, {window.rotations, noisy});
  const Eigen::Vector3d bias = fit.solution.motion.bias_rad_s;
  if (fit.turns.model != RotationModel::bias) return {std::move(fit), bias};
  Fit free = fitted(task, fit.solution.motion, {RotationModel::free});
  const int more = freedom(fit) - freedom(free);
  const bool better =
      is_significant(fit, free, more) && variance(fit) > kWorthFreeRotations * variance(free);
  if (!better) {
    add_effort(free.solution.solver, fit.solution.solver);
    return {std::move(fit), bias};
  }
  add_effort(fit.solution.solver, free.solution.solver);
  return {better_reading(task, std::move(free)), bias};
}

/// The window with a gyroscope's rotations as the sensor's data have them, where its pictures have
/// calibrated it: what they say of one plane has two readings, and they may have taken the wrong
/// one.
std::optional<Window> uncalibrated(const Window& window) {
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

/// The start optimized, then with the other planes beside the leading one, where they are asked
/// for.
Fit optimized(const Task& task, const PlaneMotion& start, SolverReport& effort) {
  Fit fit = solve(task, start, {task.window.rotations}, kStartRounds);
  add_effort(fit.solution.solver, effort);
  if (task.options.planes == Planes::one || task.window.planes.size() < 2 || !converged(fit))
    return fit;
  PlaneMotion with_others = fit.solution.motion;
  with_others.others = other_planes(task.window, with_others);
  if (with_others.others.empty()) return fit;
  Fit all = solve(task, with_others, {task.window.rotations}, kStartRounds);
  add_effort(all.solution.solver, effort);
  return converged(all) ? all : fit;
}

/// Of a residual, so that solutions with more and with fewer planes compare.
double mean_cost(const Fit& fit) {
  return converged(fit) ? fit.cost / std::max(1, fit.solution.solver.residuals)
                        : std::numeric_limits<double>::infinity();
}

/// The best of the starts that there are, so that nobody has to trust the first one: GPO with the
/// rotations as given; with those of the gyroscope before pictures calibrated it; of several planes
/// without a gyroscope the other reading of the leading one's homographies, which fits that one as
/// well, and not the others.
PlaneMotion best_start(const Task& task, SolverReport& effort) {
  std::vector<PlaneMotion> starts;
  const auto add_gpo = [&](const Window& window) {
    const PlaneSolution gpo = solve_gpo(window, {}, task.watch);
    add_effort(gpo.solver, effort);
    starts.push_back(facing(window, gpo.motion));
  };
  add_gpo(task.window);
  if (const auto raw = uncalibrated(task.window)) {
    add_gpo(*raw);
    starts.back().bias_rad_s = task.window.gyro->prior_rad_s;
  }
  const bool several = task.options.planes == Planes::all && task.window.planes.size() > 1;
  if (several && task.window.rotations == RotationModel::free) {
    if (const auto other = other_decomposition(task.window, starts.front())) starts.push_back(*other);
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

/// With the weights that the solution rests on.
void add_uncertainty(const Fit& fit, Initialization& result) {
  const PlaneMotion motion = facing(fit.window, fit.solution.motion);
  result.uncertainty =
      uncertainty_of(fit.window, fit.observations, motion, fit.turns.model, Centers::jointly);
  set_planes_uncertainty(result);
}

std::string why_wrong(const Window& window, const PlaneMotion& motion) {
  if (window.rotations != RotationModel::bias) return "";
  const GyroSensitivity& gyro = *window.gyro;
  const double bias_rad_s = motion.bias_rad_s.norm();
  if (bias_rad_s > kMostBias_rad_s)
    return fmt::format("wrong minimum: a gyroscope bias of {:.2f} rad/s fits best", bias_rad_s);
  const double sigmas = (motion.bias_rad_s - gyro.prior_rad_s).norm() / gyro.prior_sigma_rad_s;
  if (sigmas < kMostBiasSigmas) return "";
  return fmt::format(
      "wrong minimum: a gyroscope bias of {:.3f} rad/s fits best, {:.0f} standard "
      "deviations from what is known of it",
      bias_rad_s,
      sigmas);
}

}  // namespace

Initialization initialize_gpo_joint(const Window& window,
                                    const MethodOptions& options,
                                    const Watch& watch) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  const Task task{window, options, homography_error_px(window) / kMedianOfRayleigh, watch};
  SolverReport effort;
  const PlaneMotion start = best_start(task, effort);
  auto [fit, bias_rad_s] = best_fit(task, start);
  SolverReport& solver = fit.solution.solver;
  solver.milliseconds += effort.milliseconds;
  if (solver.termination != Termination::convergence) return not_converged(solver);
  fit.solution.motion.bias_rad_s = bias_rad_s;
  Initialization result = make_result(fit.window, fit.solution.motion, solver);
  if (const std::string wrong = why_wrong(window, fit.solution.motion); !wrong.empty())
    return refused(wrong, std::move(result));
  if (!result.ok) return result;
  add_uncertainty(fit, result);
  if (window.rotations == RotationModel::bias) result.bias_rad_s = bias_rad_s;
  if (fit.turns.model == RotationModel::bias && options.time_offset)
    result.time_offset_s = fit.solution.motion.time_offset_s;
  if (fit.row_delay_s != 0) result.row_delay_s = fit.row_delay_s;
  return result;
}

}  // namespace gpo
