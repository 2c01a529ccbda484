// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_solver.h"

#include "engine/base/processor.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_weights.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "tests/engine/largest.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/simulated_window.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
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
  return simulate_fitted({.motion = kMotions[seed % std::size(kMotions)],
                          .frames = static_cast<int>(between(3, 40)),
                          .points = static_cast<int>(between(12, 200)),
                          .noise_px = between(0, 1),
                          .travel = between(0.04, 0.6),
                          .tilt_deg = between(0, 60),
                          .gyro_bias_rad_s = between(0, 0.01),
                          .seed = seed});
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

struct Judged {
  PlaneUnknowns unknowns;
  bool time_offset = false;
};

class PlaneSolverJudged : public testing::TestWithParam<Judged> {};

TEST_P(PlaneSolverJudged, MatchesCeres) {
  const PlaneUnknowns& unknowns = GetParam().unknowns;
  int same = 0, equal = 0;
  for (std::uint64_t seed = 1; seed <= 160; ++seed) {
    Window window = with_noisy_gyroscope(random_window(seed).window);
    if (!GetParam().time_offset) window.gyro->time_offset_sigma_s = 0;
    const PlaneObservations observations = plane_observations(window);
    const PlaneTask task{window, observations, unknowns};
    const PlaneMotion start =
        solve_plane({window, observations, {}}, *closed_form_motion(window), {}).motion;
    const PlaneSolution ours = solve_plane(task, start, {});
    const PlaneSolution ceres = solve_plane_with_ceres(task, start, {}, 1e-16);
    EXPECT_EQ(ours.solver.unknowns, ceres.solver.unknowns);
    EXPECT_EQ(ours.solver.termination, Termination::convergence) << seed;
    EXPECT_LE(ours.solver.final_cost, ceres.solver.final_cost * (1 + 1e-9) + 1e-12) << seed;
    const bool same_cost = std::abs(ours.solver.final_cost - ceres.solver.final_cost) <
                           1e-9 * ceres.solver.final_cost + 1e-12;
    if (same_cost && unknowns.rotations == RotationModel::known) {
      EXPECT_LT(difference(ours.motion, ceres.motion), 1e-8) << seed;
    }
    same += same_cost ? 1 : 0;
    equal += difference(ours.motion, ceres.motion) < 1e-9 ? 1 : 0;
  }
  EXPECT_GE(same, 157);
  // In the others the cost hardly depends on the normal (little parallax, motion along it), and
  // Ceres stops at rounding errors.
  EXPECT_GE(equal, unknowns.rotations == RotationModel::known ? 145 : 120);
}

INSTANTIATE_TEST_SUITE_P(
    ,
    PlaneSolverJudged,
    testing::Values(Judged{{.rotations = RotationModel::known}},
                    Judged{{.rotations = RotationModel::bias}},
                    Judged{{.rotations = RotationModel::bias}, true},
                    Judged{{.rotations = RotationModel::bias, .gyro_noise = true}},
                    Judged{{.rotations = RotationModel::bias, .gyro_noise = true}, true},
                    Judged{{.rotations = RotationModel::free}}),
    [](const auto& each) {
      return std::string(to_string(each.param.unknowns.rotations)) +
             (each.param.time_offset ? "_and_offset" : "") +
             (each.param.unknowns.gyro_noise ? "_and_noise" : "");
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
  PlaneMotion start = true_motion(truth);
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
      without_rolling_shutter(truth.window, true_motion(truth), RotationModel::known, {});
  for (int i = 0; i < same.frame_count(); ++i)
    EXPECT_LT(largest(same.points_px[i] - truth.window.points_px[i]), 1e-9);
}

TEST(RollingShutter, IsCorrectedOnTruePath) {
  const SimulationOptions options{.motion = Motion::wander, .noise_px = 0, .seed = 4};
  SimulationOptions rolling = options;
  rolling.row_delay_s = kRowDelay_s;
  const Simulation global = simulate(options);
  const Simulation seen = simulate(rolling);
  const Window corrected =
      without_rolling_shutter(seen.window, true_motion(seen), RotationModel::known, {kRowDelay_s});
  std::vector<double> before, after;
  for (int i = 1; i + 1 < corrected.frame_count(); ++i)
    for (int j = 0; j < corrected.track_count(); ++j) {
      const Eigen::Vector2d exact = global.window.points_px[i].col(j);
      before.push_back((seen.window.points_px[i].col(j) - exact).norm());
      after.push_back((corrected.points_px[i].col(j) - exact).norm());
    }
  EXPECT_GT(median(before), 0.5);
  EXPECT_LT(median(after), 0.02 * median(before));
}

TEST(RollingShutter, IsEstimatedByGpoJoint) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate_fitted({.motion = Motion::wander,
                                              .noise_px = 0.1,
                                              .gyro_bias_rad_s = 0.002,
                                              .row_delay_s = kRowDelay_s,
                                              .seed = seed});
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
    const Simulation truth =
        simulate_fitted({.motion = Motion::wander, .gyro_bias_rad_s = 0.002, .seed = seed});
    found += initialize_gpo_joint(truth.window, {}, {}).row_delay_s ? 1 : 0;
  }
  EXPECT_LE(found, 1);
}

Simulation rolling_window(Motion motion, std::uint64_t seed) {
  return simulate_fitted({.motion = motion, .row_delay_s = kRowDelay_s, .seed = seed});
}

TEST(RollingShutter, KnownDelayIsUsedAndNotEstimated) {
  std::vector<double> known_deg, global_deg;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Simulation truth = rolling_window(Motion::wander, seed);
    truth.window.row_delay = RowDelayPrior{kRowDelay_s, 0};
    const Initialization known = initialize_gpo_joint(truth.window, {}, {});
    const Initialization estimated =
        initialize_gpo_joint(truth.window, {.shutter = Shutter::estimated}, {});
    ASSERT_TRUE(known.ok && estimated.ok) << known.reason << estimated.reason;
    EXPECT_EQ(known.row_delay_s, kRowDelay_s);
    EXPECT_NE(estimated.row_delay_s, kRowDelay_s);
    known_deg.push_back(normal_error_deg(known, truth));
    global_deg.push_back(normal_error_deg(
        initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {}), truth));
  }
  EXPECT_LT(median(known_deg), 0.3 * median(global_deg));
}

TEST(RollingShutter, KnownGlobalShutterIsNotCorrected) {
  Simulation truth = rolling_window(Motion::wander, 1);
  truth.window.row_delay = RowDelayPrior{0, 0};
  const Initialization known = initialize_gpo_joint(truth.window, {}, {});
  const Initialization global =
      initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {});
  EXPECT_FALSE(known.row_delay_s);
  EXPECT_EQ(known.plane.normal, global.plane.normal);
}

/// The change of the solution by one standard deviation of the delay is a part of its covariance.
TEST(RollingShutter, UncertaintyOfAKnownDelayAddsTheChangeOfTheSolution) {
  Simulation truth = rolling_window(Motion::sideways, 3);
  const auto at = [&](double row_delay_s, double sigma_s) {
    truth.window.row_delay = RowDelayPrior{row_delay_s, sigma_s};
    return initialize_gpo_joint(
        truth.window, {.error = ErrorModel::transfer, .loss = Loss::squared}, {});
  };
  constexpr double kSigma_s = 4e-6;
  const Initialization exact = at(kRowDelay_s, 0), uncertain = at(kRowDelay_s, kSigma_s);
  const Vector3d change =
      (at(kRowDelay_s + kSigma_s, 0).plane.normal - at(kRowDelay_s - kSigma_s, 0).plane.normal) / 2;
  const double added = uncertain.uncertainty->normal_covariance.trace() -
                       exact.uncertainty->normal_covariance.trace();
  EXPECT_NEAR(added, change.squaredNorm(), 0.2 * change.squaredNorm());
  EXPECT_EQ(uncertain.uncertainty->row_delay_sigma_s, kSigma_s);
}

class TurnedWindow : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(QuarterTurns, TurnedWindow, testing::Values(1, 2, 3));

TEST_P(TurnedWindow, HasTheSameNormalAndRowDelay) {
  const Simulation upright = rolling_window(Motion::wander, 2);
  const Simulation rotated = turned(upright, GetParam());
  const Eigen::Matrix3d R = so3_exp({0, 0, GetParam() * std::numbers::pi / 2});
  for (const ErrorModel error : {ErrorModel::transfer, ErrorModel::latent})
    for (const Shutter shutter : {Shutter::known, Shutter::estimated}) {
      const auto result = [&](Window window) {
        if (shutter == Shutter::known) window.row_delay = RowDelayPrior{kRowDelay_s, 1e-7};
        return initialize_gpo_joint(window, {.error = error, .shutter = shutter}, {});
      };
      const Initialization one = result(upright.window), other = result(rotated.window);
      ASSERT_TRUE(one.row_delay_s && other.row_delay_s) << one.reason << other.reason;
      EXPECT_NEAR(*other.row_delay_s, *one.row_delay_s, 1e-3 * kRowDelay_s);
      EXPECT_LT((other.plane.normal - R * one.plane.normal).norm(), 1e-5);
    }
}

/// A frame away from its minimum, where all terms are large.
struct Disturbed {
  Simulation truth;
  PlaneObservations observations;
  PlaneMotion motion;
  int frame = 6;

  explicit Disturbed(std::uint64_t seed, int points = 37)
      : truth(simulate({.motion = Motion::wander, .frames = 9, .points = points, .seed = seed})),
        observations(plane_observations(truth.window)),
        motion(true_motion(truth)) {
    motion.normal = moved_normal(motion.normal, {0.05, -0.03});
    motion.tau[frame] += Vector3d(0.01, 0.02, -0.03);
    motion.R_wc[frame] *= so3_exp({0.01, -0.02, 0.015});
  }

  FrameState state() const { return frame_state(observations, motion, frame); }
};

/// Returns the normal equations from `transfer_on_plane`, which has its own test.
FrameNormals by_transfer(const Disturbed& d, Rotating rotating) {
  FrameNormals sum;
  const FrameObservations& f = d.observations.frames[d.frame];
  const FrameState state = d.state();
  for (int k = 0; k < f.count; ++k) {
    Eigen::Matrix<double, 2, 8> J = transfer_of(f, state, k).jacobian(state.tangents);
    if (rotating == Rotating::no) J.middleCols<3>(2).setZero();
    const Eigen::Vector2d r = transfer_error_px(f, state, k);
    sum.JtJ += J.transpose() * J;
    sum.Jtr += J.transpose() * r;
    sum.cost += 0.5 * r.squaredNorm();
  }
  return sum;
}

void expect_equal(const FrameNormals& a, const FrameNormals& b) {
  EXPECT_TRUE(a.in_front);
  EXPECT_LT((a.JtJ - b.JtJ).norm(), 1e-11 * b.JtJ.norm());
  EXPECT_LT((a.Jtr - b.Jtr).norm(), 1e-11 * b.Jtr.norm());
  EXPECT_NEAR(a.cost, b.cost, 1e-11 * b.cost);
}

TEST(PlaneKernel, AllVersionsSumJacobiansOfTransfer) {
  for (const int points : {8, 9, 10, 11, 150})
    for (const Rotating rotating : {Rotating::no, Rotating::yes}) {
      const Disturbed d(points, points);
      const auto& observations = d.observations.frames[d.frame];
      const FrameNormals expected = by_transfer(d, rotating);
      expect_equal(frame_normals_baseline(observations, d.state(), rotating), expected);
      expect_equal(frame_normals(observations, d.state(), rotating), expected);
      if (has_avx2_fma())
        expect_equal(frame_normals_avx2_fma(observations, d.state(), rotating), expected);
    }
}

TEST(PlaneKernel, MatchesUnitWeightMatrices) {
  const Disturbed d(4);
  FrameObservations weighted = d.observations.frames[d.frame];
  weighted.weight.assign(weighted.count, Eigen::Matrix2d::Identity());
  expect_equal(frame_normals(d.observations.frames[d.frame], d.state(), Rotating::yes),
               weighted_normals(weighted, d.state(), Rotating::yes));
}

TEST(PlaneKernel, DetectsPointBehindCamera) {
  Disturbed d(5);
  EXPECT_TRUE(frame_normals(d.observations.frames[d.frame], d.state(), Rotating::no).in_front);
  d.motion.R_wc[d.frame] *= so3_exp({0, 2.5, 0});
  EXPECT_FALSE(frame_normals(d.observations.frames[d.frame], d.state(), Rotating::no).in_front);
}

TEST(GyroColumns, MatchFiniteDifferences) {
  const Simulation truth = simulate({.motion = Motion::wander, .gyro_bias_rad_s = 0.01, .seed = 4});
  const int frame = 17;
  PlaneMotion motion = motion_without_translation(truth.window);
  motion.bias_rad_s += Vector3d(0.3, -0.2, 0.1);
  motion.time_offset_correction_s = 0.1;
  motion.gyro_noise_rad.assign(truth.window.frame_count(), Vector3d(0.2, -0.3, 0.1));
  const GyroColumns columns = gyro_columns(truth.window, motion, frame, 4);
  const auto rotation = [&](int unknown, double step) {
    PlaneMotion moved = motion;
    (unknown == 3 ? moved.time_offset_correction_s : moved.bias_rad_s[unknown]) += step;
    return gyro_rotation(truth.window, frame, moved);
  };
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 4; ++k) {
    const Vector3d numeric =
        so3_log(rotation(k, -kStep).transpose() * rotation(k, kStep)) / (2 * kStep);
    EXPECT_LT((columns.col(k) - numeric).norm(), 1e-7) << k;
  }
}

TEST(GyroNoise, GrowsWithRootOfTime) {
  Simulation truth = simulate({.frames = 17, .gyro_bias_rad_s = 0});
  truth.window.gyro->noise_density = 1e-3;
  EXPECT_EQ(gyro_noise_sigma_rad(truth.window, 0), 0);
  EXPECT_NEAR(gyro_noise_sigma_rad(truth.window, 4), 1e-3 * std::sqrt(4 / 30.0), 1e-9);
  EXPECT_NEAR(gyro_noise_sigma_rad(truth.window, 16), 2e-3 * std::sqrt(4 / 30.0), 1e-9);
}

}  // namespace
}  // namespace gpo::test
