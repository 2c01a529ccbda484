// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_solver.h"

#include "engine/methods/plane/plane_problem.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace gpo {
namespace {

constexpr int kUsualIterations = 16;
constexpr double kSettled = 1e-10;      // length of a step [rad, plane distances, rad/s]
constexpr double kRounding = 1e-12;     // relative change of the cost below rounding errors
constexpr int kMostHiddenSteps = 5;     // in a valley whose slope is below rounding errors
constexpr double kFirstDamping = 1e-4;  // relative to the diagonal, if Gauss-Newton fails
constexpr double kLargestDamping = 1e12;

template <class S>
PlaneSolution minimize(const PlaneTask& task,
                       const PlaneMotion& start,
                       const Watch& watch,
                       int most_steps) {
  const PlaneProblem<S> problem(task);
  PlaneSolution solution{start, {}};
  SolverReport& report = solution.solver;
  report.unknowns = problem.unknown_count();
  report.termination = Termination::no_convergence;
  Linearized<S> at, there;
  problem.linearize(start, at);
  report.initial_cost = at.cost;
  if (!at.in_front || !std::isfinite(at.cost)) report.termination = Termination::failure;
  report.trace.reserve(kUsualIterations);
  report.trace.push_back({at.cost, problem.gradient(at), 0, start.normal});
  double damping = 0;
  int hidden_steps = 0, taken = 0;
  while (report.termination == Termination::no_convergence && taken < most_steps &&
         report.iterations < kMostSteps && !watch.stop_requested()) {
    ++report.iterations;
    const auto step = problem.step(at, damping);
    PlaneMotion moved = problem.moved(solution.motion, step);
    problem.linearize(moved, there);
    // Close to the minimum the cost's rounding errors exceed its decrease: accept the step.
    const bool hidden = std::abs(step.decrease) < kRounding * at.cost;
    const bool better = there.in_front && (there.cost <= at.cost || hidden);
    hidden_steps += hidden ? 1 : 0;
    const bool settled = step.length < kSettled || hidden_steps == kMostHiddenSteps;
    if (better) {
      ++taken;
      solution.motion = std::move(moved);
      std::swap(at, there);
      damping = damping > kFirstDamping ? damping / 10 : 0;
      report.trace.push_back({at.cost, problem.gradient(at), step.norm, solution.motion.normal});
    } else {
      damping = std::max(10 * damping, kFirstDamping);
      report.trace.push_back(report.trace.back());
      report.trace.back().step = 0;
    }
    watch.report(report.iterations, at.cost);
    if (settled) report.termination = Termination::convergence;
    if (!(damping < kLargestDamping)) report.termination = Termination::failure;
  }
  report.final_cost = at.cost;
  return solution;
}

/// Counts the gyroscope's rotations as measurements if its noise is an unknown.
int residual_count(const PlaneTask& task) {
  const int frames = static_cast<int>(task.observations.frames.size());
  return 2 * task.observations.count() + (task.unknowns.gyro_noise ? 3 * (frames - 1) : 0);
}

}  // namespace

PlaneMotion with_noise_unknowns(PlaneMotion start, const PlaneUnknowns& unknowns) {
  if (!unknowns.gyro_noise) start.gyro_noise_rad.clear();
  if (unknowns.gyro_noise && start.gyro_noise_rad.empty())
    start.gyro_noise_rad.assign(start.tau.size(), Eigen::Vector3d::Zero());
  return start;
}

PlaneSolution solve_plane(const PlaneTask& task,
                          const PlaneMotion& start,
                          const Watch& watch,
                          int most_steps) {
  const auto begin = std::chrono::steady_clock::now();
  const PlaneUnknowns& unknowns = task.unknowns;
  const bool free = unknowns.rotations == RotationModel::free || unknowns.gyro_noise;
  const bool normal_only = task.observations.others.empty() && !unknowns.gyro_noise &&
                           unknowns.rotations != RotationModel::bias;
  const auto solve = normal_only ? (free ? minimize<FreeRotations> : minimize<KnownRotations>)
                     : free      ? minimize<AnySharedFree>
                                 : minimize<AnyShared>;
  PlaneSolution solution = solve(task, with_noise_unknowns(start, unknowns), watch, most_steps);
  solution.solver.residuals = residual_count(task);
  solution.solver.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return solution;
}

}  // namespace gpo
