// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_solver.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "tests/engine/methods/method_cases.h"

#include <random>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;

/// Simulates windows of all difficulties: few and many points and frames, short and long paths,
/// flat and steep planes.
Simulation random_window(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  return with_fitted_homographies(simulate({.motion = kMotions[seed % std::size(kMotions)],
                                            .frames = static_cast<int>(between(3, 40)),
                                            .points = static_cast<int>(between(12, 200)),
                                            .noise_px = between(0, 1),
                                            .travel = between(0.04, 0.6),
                                            .tilt_deg = between(0, 60),
                                            .gyro_bias_rad_s = between(0, 0.01),
                                            .seed = seed}));
}

/// Returns the largest difference of normals [rad], translations [d], rotations [rad] and biases
/// [rad/s].
double difference(const PlaneMotion& a, const PlaneMotion& b) {
  const double sign = a.normal.dot(b.normal) < 0 ? -1 : 1;
  double most = std::max((a.normal - sign * b.normal).norm(), (a.bias_rad_s - b.bias_rad_s).norm());
  for (std::size_t i = 0; i < a.tau.size(); ++i) {
    most = std::max(most, (a.tau[i] - sign * b.tau[i]).norm());
    most = std::max(most, so3_log(a.R_wc[i].transpose() * b.R_wc[i]).norm());
  }
  return most;
}

Window with_noisy_gyroscope(Window window, double noise_density = 3e-4) {
  window.gyro->noise_density = noise_density;
  return window;
}

class PlaneSolverJudged : public testing::TestWithParam<PlaneUnknowns> {};

TEST_P(PlaneSolverJudged, MatchesCeres) {
  int same = 0;
  int equal = 0;
  for (std::uint64_t seed = 1; seed <= 160; ++seed) {
    const Window window = with_noisy_gyroscope(random_window(seed).window);
    const PlaneObservations observations = plane_observations(window);
    const PlaneTask task{window, observations, GetParam()};
    const PlaneMotion start =
        solve_plane({window, observations, {}}, *closed_form_motion(window), {}).motion;
    const PlaneSolution ours = solve_plane(task, start, {});
    const PlaneSolution ceres = solve_plane_with_ceres(task, start, {}, 1e-16);
    EXPECT_EQ(ours.solver.unknowns, ceres.solver.unknowns);
    EXPECT_EQ(ours.solver.termination, Termination::convergence) << seed;
    EXPECT_LE(ours.solver.final_cost, ceres.solver.final_cost * (1 + 1e-9) + 1e-12) << seed;
    const bool same_cost = std::abs(ours.solver.final_cost - ceres.solver.final_cost) <
                           1e-9 * ceres.solver.final_cost + 1e-12;
    if (same_cost && GetParam().rotations == RotationModel::known) {
      EXPECT_LT(difference(ours.motion, ceres.motion), 1e-8) << seed;
    }
    same += same_cost ? 1 : 0;
    equal += difference(ours.motion, ceres.motion) < 1e-9 ? 1 : 0;
  }
  EXPECT_GE(same, 157);
  // In the others the cost hardly depends on the normal (little parallax, motion along it), and
  // Ceres stops at rounding errors.
  EXPECT_GE(equal, GetParam().rotations == RotationModel::known ? 145 : 120);
}

INSTANTIATE_TEST_SUITE_P(
    ,
    PlaneSolverJudged,
    testing::Values(PlaneUnknowns{.rotations = RotationModel::known},
                    PlaneUnknowns{.rotations = RotationModel::bias},
                    PlaneUnknowns{.rotations = RotationModel::bias, .time_offset = true},
                    PlaneUnknowns{.rotations = RotationModel::bias, .gyro_noise = true},
                    PlaneUnknowns{
                        .rotations = RotationModel::bias, .time_offset = true, .gyro_noise = true},
                    PlaneUnknowns{.rotations = RotationModel::free}),
    [](const auto& each) {
      return std::string(to_string(each.param.rotations)) +
             (each.param.time_offset ? "_and_offset" : "") +
             (each.param.gyro_noise ? "_and_noise" : "");
    });

TEST(PlaneSolver, IsExactWithoutNoise) {
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::wander}) {
    const Simulation truth =
        simulate({.motion = motion, .noise_px = 0, .gyro_bias_rad_s = 0.005, .seed = 7});
    // A prior without influence.
    Window window = truth.window;
    window.gyro->prior_sigma_rad_s = 1e6;
    const PlaneSolution solution =
        solve_plane({window, plane_observations(window), {.rotations = RotationModel::bias}},
                    *closed_form_motion(window),
                    {});
    const PlaneMotion found = facing(window, solution.motion);
    // The rotations depend on the bias linearly only to first order.
    EXPECT_LT(angle_deg(found.normal, truth.plane.normal), 2e-3);
    EXPECT_LT((found.bias_rad_s - truth.bias_rad_s).norm(), 2e-5);
  }
}

TEST(PlaneSolver, EstimatesFreeRotations) {
  const Simulation truth = simulate({.motion = Motion::wander, .noise_px = 0, .seed = 8});
  PlaneMotion start = motion_of(truth.plane, truth.cameras);
  for (std::size_t i = 1; i < start.R_wc.size(); ++i) start.R_wc[i] *= so3_exp({0.01, -0.01, 0.02});
  const PlaneSolution solution = solve_plane(
      {truth.window, plane_observations(truth.window), {.rotations = RotationModel::free}},
      start,
      {});
  EXPECT_LT(difference(solution.motion, motion_of(truth.plane, truth.cameras)), 1e-8);
}

/// The limits are a gyroscope without noise and no gyroscope.
TEST(PlaneSolver, WeighsGyroscopeByItsNoise) {
  const Simulation truth = simulate({.motion = Motion::orbit, .gyro_bias_rad_s = 0.002, .seed = 9});
  const PlaneObservations observations = plane_observations(truth.window);
  const PlaneMotion start = *closed_form_motion(truth.window);
  const auto solved = [&](double noise_density, const PlaneUnknowns& unknowns) {
    const Window window = with_noisy_gyroscope(truth.window, noise_density);
    return solve_plane({window, observations, unknowns}, start, {}).motion;
  };
  const PlaneUnknowns noisy{.rotations = RotationModel::bias, .gyro_noise = true};
  const PlaneMotion exact = solved(0, {.rotations = RotationModel::bias});
  const PlaneMotion none = solved(0, {.rotations = RotationModel::free});
  EXPECT_LT(difference(solved(1e-9, noisy), exact), 1e-8);
  PlaneMotion worthless = solved(1e4, noisy);
  worthless.bias_rad_s = none.bias_rad_s;  // not observable
  EXPECT_LT(difference(worthless, none), 1e-7);
  EXPECT_GT(difference(exact, none), 1e-4);
}

TEST(PlaneSolver, FailsForStartBehindCamera) {
  const Simulation truth = simulate({});
  PlaneMotion start = motion_of(truth.plane, truth.cameras);
  start.R_wc[3] *= so3_exp({0, 3, 0});
  const PlaneSolution solution =
      solve_plane({truth.window, plane_observations(truth.window), {}}, start, {});
  EXPECT_EQ(solution.solver.termination, Termination::failure);
}

TEST(PlaneSolver, StopsOnRequest) {
  const Simulation truth = simulate({});
  const PlaneSolution solution = solve_plane({truth.window, plane_observations(truth.window), {}},
                                             motion_without_translation(truth.window),
                                             stopped());
  EXPECT_EQ(solution.solver.iterations, 0);
}

constexpr double kRowDelay_s = 4e-5;  // about 20 ms per image

TEST(RollingShutter, KeepsPointsWithoutDelay) {
  const Simulation truth = simulate({.motion = Motion::wander, .noise_px = 0});
  const Window same =
      without_rolling_shutter(truth.window, motion_of(truth.plane, truth.cameras), 0);
  for (int i = 0; i < same.frame_count(); ++i)
    EXPECT_LT((same.points_px[i] - truth.window.points_px[i]).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(RollingShutter, IsCorrectedOnTruePath) {
  const SimulationOptions options{.motion = Motion::wander, .noise_px = 0, .seed = 4};
  SimulationOptions rolling = options;
  rolling.row_delay_s = kRowDelay_s;
  const Simulation global = simulate(options);
  const Simulation seen = simulate(rolling);
  const Window corrected =
      without_rolling_shutter(seen.window, motion_of(seen.plane, seen.cameras), kRowDelay_s);
  std::vector<double> before;
  std::vector<double> after;
  for (int i = 1; i + 1 < corrected.frame_count(); ++i) {
    for (int j = 0; j < corrected.track_count(); ++j) {
      const Eigen::Vector2d exact = global.window.points_px[i].col(j);
      before.push_back((seen.window.points_px[i].col(j) - exact).norm());
      after.push_back((corrected.points_px[i].col(j) - exact).norm());
    }
  }
  EXPECT_GT(median(before), 0.5);
  EXPECT_LT(median(after), 0.02 * median(before));
}

TEST(RollingShutter, IsEstimatedByGpoJoint) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = with_fitted_homographies(simulate({.motion = Motion::wander,
                                                                .noise_px = 0.1,
                                                                .gyro_bias_rad_s = 0.002,
                                                                .row_delay_s = kRowDelay_s,
                                                                .seed = seed}));
    const Initialization rolling = initialize_gpo_joint(truth.window, {}, {});
    const Initialization global =
        initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {});
    ASSERT_TRUE(rolling.ok);
    ASSERT_TRUE(rolling.row_delay_s);
    EXPECT_NEAR(*rolling.row_delay_s, kRowDelay_s, 0.1 * kRowDelay_s);
    EXPECT_LT(normal_error_deg(rolling, truth), 0.3 * normal_error_deg(global, truth));
  }
}

TEST(RollingShutter, IsRarelyFoundForGlobalShutter) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Simulation truth = with_fitted_homographies(
        simulate({.motion = Motion::wander, .gyro_bias_rad_s = 0.002, .seed = seed}));
    found += initialize_gpo_joint(truth.window, {}, {}).row_delay_s ? 1 : 0;
  }
  EXPECT_LE(found, 1);
}

}  // namespace
}  // namespace gpo::test
