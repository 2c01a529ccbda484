// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/initializers.h"
#include "engine/methods/methods.h"
#include "tests/engine/simulated_window.h"

#include <set>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::Motion;
using test::simulate;
using test::Simulation;
using test::with_fitted_homographies;

struct TracedCase {
  std::string method;
  Solver solver = Solver::schur;
};

std::vector<TracedCase> cases() {
  std::vector<TracedCase> all;
  for (const Method& method : methods()) {
    all.push_back({method.key});
    if (method.key.starts_with("gpo")) all.push_back({method.key, Solver::ceres});
  }
  return all;
}

class EveryTrace : public ::testing::TestWithParam<TracedCase> {
 protected:
  static Initialization run(const Window& window) {
    // Ceres omits the last steps within its tolerance in each round of weights.
    const Loss loss = GetParam().solver == Solver::ceres ? Loss::squared : Loss::huber;
    return find_method(GetParam().method)
        .initialize(window, {.solver = GetParam().solver, .loss = loss}, {});
  }
  static bool optimizes() {
    return !std::set<std::string>{"pnp", "dbscan", "closed_form"}.contains(GetParam().method);
  }
  static bool over_a_plane() {
    return std::set<std::string>{"gpo", "gpo_joint", "pba", "fpba"}.contains(GetParam().method);
  }
};

void expect_from_initial_to_final_cost(const SolverReport& solver) {
  EXPECT_NEAR(solver.trace.front().cost, solver.initial_cost, 1e-9 * solver.initial_cost);
  EXPECT_NEAR(solver.trace.back().cost, solver.final_cost, 1e-9 * solver.final_cost);
  EXPECT_LE(static_cast<int>(solver.trace.size()), solver.iterations + 1);
  EXPECT_EQ(solver.trace.front().step, 0);
}

void expect_descent(const SolverReport& solver) {
  for (std::size_t k = 1; k < solver.trace.size(); ++k)
    EXPECT_LE(solver.trace[k].cost, solver.trace[k - 1].cost * (1 + 1e-9)) << "iteration " << k;
  if (solver.trace.front().gradient < 1e-6) return;  // gpo_joint from GPO with known rotations
  EXPECT_LT(solver.trace.back().gradient, 1e-2 * solver.trace.front().gradient);
  EXPECT_GT(solver.trace[1].step, solver.trace.back().step);
}

TEST_P(EveryTrace, ContainsStartAndResult) {
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::wander}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(testing::Message() << "motion " << static_cast<int>(motion) << " seed " << seed);
      const Simulation truth =
          with_fitted_homographies(simulate({.motion = motion, .off_plane = 0.1, .seed = seed}));
      const Initialization result = run(truth.window);
      ASSERT_TRUE(result.ok) << result.reason;
      ASSERT_EQ(!result.solver.trace.empty(), optimizes());
      if (!optimizes()) continue;
      expect_from_initial_to_final_cost(result.solver);
      expect_descent(result.solver);
      for (const SolverStep& step : result.solver.trace)
        EXPECT_EQ(step.normal.has_value(), over_a_plane());
      if (over_a_plane()) {
        EXPECT_EQ(*result.solver.trace.back().normal, result.plane.normal);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryTrace, ::testing::ValuesIn(cases()), [](const auto& p) {
  return p.param.method + (p.param.solver == Solver::ceres ? "_by_ceres" : "");
});

TEST(Trace, KeepsVisibleSignFromStartAtRest) {
  const Simulation truth = simulate({.motion = Motion::orbit});
  const Initialization result = initialize_gpo(truth.window, {.solver = Solver::ceres}, {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_EQ(*result.solver.trace.front().normal, -Eigen::Vector3d::UnitZ());
  for (const SolverStep& step : result.solver.trace) EXPECT_LT(step.normal->z(), 0);
}

TEST(Trace, CombinesAllRounds) {
  const Simulation truth = with_fitted_homographies(
      simulate({.motion = Motion::orbit, .gyro_bias_rad_s = 0.002, .row_delay_s = 3e-5}));
  for (const MethodOptions& options :
       {MethodOptions{},
        MethodOptions{.time_offset = true},
        MethodOptions{.loss = Loss::huber},
        MethodOptions{.error = ErrorModel::sampson, .shutter = Shutter::global}}) {
    const Initialization result = initialize_gpo_joint(truth.window, options, {});
    ASSERT_TRUE(result.ok) << result.reason;
    expect_from_initial_to_final_cost(result.solver);
    EXPECT_EQ(*result.solver.trace.back().normal, result.plane.normal);
  }
}

}  // namespace
}  // namespace gpo
