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

constexpr int kMostIterations = 300;
constexpr int kUsualIterations = 16;
constexpr double kSettled = 1e-10;      // length of a step [rad, plane distances, rad/s]
constexpr double kRounding = 1e-12;     // relative change of the cost that says nothing
constexpr int kMostHiddenSteps = 5;     // along a valley so flat that rounding fills it
constexpr double kFirstDamping = 1e-4;  // relative to the diagonal, where Gauss-Newton fails
constexpr double kMostDamping = 1e12;

template <class S>
PlaneSolution minimize(const PlaneProblem<S>& problem,
                       const PlaneMotion& start,
                       const Watch& watch) {
  PlaneSolution solution{start, {}};
  SolverReport& report = solution.solver;
  report.unknowns = problem.unknown_count();
  report.termination = Termination::no_convergence;
  Linearized at = problem.linearize(start);
  report.initial_cost = at.cost;
  if (!at.in_front || !std::isfinite(at.cost)) report.termination = Termination::failure;
  report.trace.reserve(kUsualIterations);
  report.trace.push_back({at.cost, problem.gradient(at, start), 0, start.normal});
  double damping = 0;
  int hidden_steps = 0;
  while (report.termination == Termination::no_convergence && report.iterations < kMostIterations &&
         !watch.stop_requested()) {
    ++report.iterations;
    const auto step = problem.step(at, solution.motion, damping);
    const PlaneMotion moved = problem.moved(solution.motion, step);
    Linearized there = problem.linearize(moved);
    // What rounding leaves of the cost cannot tell whether the last steps are good; they are.
    const bool hidden = std::abs(step.decrease) < kRounding * at.cost;
    const bool better = there.in_front && (there.cost <= at.cost || hidden);
    hidden_steps += hidden ? 1 : 0;
    const bool settled = step.length < kSettled || hidden_steps == kMostHiddenSteps;
    if (better) {
      solution.motion = moved;
      at = std::move(there);
      damping = damping > kFirstDamping ? damping / 10 : 0;
      report.trace.push_back({at.cost, problem.gradient(at, moved), step.norm, moved.normal});
    } else {
      damping = std::max(10 * damping, kFirstDamping);
      report.trace.push_back(report.trace.back());
      report.trace.back().step = 0;
    }
    watch.tell(report.iterations, at.cost);
    if (settled) report.termination = Termination::convergence;
    if (!(damping < kMostDamping)) report.termination = Termination::failure;
  }
  report.final_cost = at.cost;
  return solution;
}

template <class S>
PlaneSolution solve_split(const Window& window,
                          const PlaneObservations& observations,
                          const PlaneMotion& start,
                          const PlaneUnknowns& unknowns,
                          const Watch& watch) {
  return minimize(PlaneProblem<S>(window, observations, unknowns), start, watch);
}

}  // namespace

PlaneMotion started(PlaneMotion start, const PlaneUnknowns& unknowns) {
  if (!unknowns.gyro_noise) start.gyro_noise_rad.clear();
  if (unknowns.gyro_noise && start.gyro_noise_rad.empty())
    start.gyro_noise_rad.assign(start.tau.size(), Eigen::Vector3d::Zero());
  return start;
}

namespace {

/// A gyroscope's rotations are measurements, too, where its noise is unknown.
int residual_count(const PlaneObservations& observations, const PlaneUnknowns& unknowns) {
  const int frames = static_cast<int>(observations.frames.size());
  return 2 * observations.count() + (unknowns.gyro_noise ? 3 * (frames - 1) : 0);
}

}  // namespace

PlaneSolution solve_plane(const Window& window,
                          const PlaneObservations& observations,
                          const PlaneMotion& start,
                          const PlaneUnknowns& unknowns,
                          const Watch& watch) {
  const auto begin = std::chrono::steady_clock::now();
  const bool free = unknowns.rotations == RotationModel::free || unknowns.gyro_noise;
  const bool normal_only = observations.others.empty() && !unknowns.gyro_noise &&
                           unknowns.rotations != RotationModel::bias;
  const auto solve = normal_only ? (free ? solve_split<FreeRotations> : solve_split<KnownRotations>)
                     : free      ? solve_split<AnySharedFree>
                                 : solve_split<AnyShared>;
  PlaneSolution solution = solve(window, observations, started(start, unknowns), unknowns, watch);
  solution.solver.residuals = residual_count(observations, unknowns);
  solution.solver.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return solution;
}

}  // namespace gpo
