// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/methods/initializers.h"
#include "engine/methods/methods.h"
#include "engine/methods/uncertainty/information.h"
#include "engine/methods/uncertainty/uncertainty.h"
#include "tests/engine/methods/method_cases.h"

#include <functional>
#include <map>
#include <string>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

class GpoOnMotion : public testing::TestWithParam<Motion> {};

TEST_P(GpoOnMotion, RecoversNoiseFreeWindowsExactly) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate({.motion = GetParam(), .noise_px = 0, .seed = seed});
    const Initialization result = successful(initialize_gpo(truth.window, {}, {}));
    EXPECT_LT(normal_error_deg(result, truth), 1e-6);
    expect_exact_cameras(result, truth);
    for (const MapPoint& point : result.points)
      EXPECT_NEAR(truth.plane.normal.dot(point.position) + 1, 0, 1e-6);
  }
}

TEST_P(GpoOnMotion, ReachesCramerRaoBoundTimesOnePointTwo) {
  std::vector<double> errors, bounds;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Simulation truth = simulate({.motion = GetParam(), .seed = seed});
    const Initialization result = successful(initialize_gpo(truth.window, {}, {}));
    errors.push_back(normal_error_deg(result, truth));
    bounds.push_back(*normal_bound_deg(truth.window, truth.plane, truth.cameras, 0.5));
  }
  EXPECT_LE(median(errors), 1.2 * median(bounds));
  // The median length of a two-dimensional Gaussian is 0.83 of its RMS.
  EXPECT_GE(median(errors), 0.5 * median(bounds));
}

INSTANTIATE_TEST_SUITE_P(All, GpoOnMotion, testing::ValuesIn(kUsualMotions));

TEST(Gpo, CountsUnknownsAndResidualsLikeThePaper) {
  const Simulation truth = simulate({});
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_EQ(result.solver.unknowns, 3 * 30 - 1);
  EXPECT_EQ(result.solver.residuals, 2 * 150 * 29);
  EXPECT_EQ(result.solver.termination, Termination::convergence);
  EXPECT_LE(result.solver.iterations, 300);
  EXPECT_LT(result.solver.final_cost, result.solver.initial_cost);
  EXPECT_NEAR(result.rms_px, 0.5 * std::sqrt(2), 0.05);  // both coordinates
}

TEST(Gpo, IsIndependentOfOrderOfTracks) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Initialization a = initialize_gpo(truth.window, {}, {});
  const Initialization b = initialize_gpo(with_reversed_tracks(truth.window), {}, {});
  EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 1e-6);
}

TEST(Gpo, RotatesNormalWithReferenceFrame) {
  const Simulation upright = simulate({.motion = Motion::orbit, .seed = 3});
  const Initialization a = initialize_gpo(upright.window, {}, {});
  const Initialization b = initialize_gpo(turned(upright, 1).window, {}, {});
  EXPECT_LT(angle_deg(so3_exp({0, 0, std::acos(0)}) * a.plane.normal, b.plane.normal), 1e-6);
}

TEST(Gpo, UsesTracksOnlyInFramesThatObserveThem) {
  Simulation truth = simulate({.noise_px = 0});
  hide_tracks(truth.window, 0, 60);
  const Initialization result = successful(initialize_gpo(truth.window, {}, {}));
  EXPECT_LT(normal_error_deg(result, truth), 1e-6);
  EXPECT_EQ(result.solver.residuals, 2 * (150 * 9 + 90 * 20));
}

TEST(Gpo, ReportsLeastNumberOfInliers) {
  Simulation truth = simulate({});
  for (int j = 7; j < 150; ++j) truth.window.inlier[12][j] = false;
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.reason, "too few inliers: frame 12 has 7, at least 8 are needed");
}

TEST(Gpo, RejectsWrongRotations) {
  Simulation truth = simulate({.motion = Motion::orbit});
  for (int i = 0; i < 30; ++i) truth.window.R_wc[i] = so3_exp({0, 0, 0.02 * i});
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("no convergence"));
}

/// Simulates an uncorrected bias and 15 % of the tracks off the plane.
Simulation biased(Motion motion, std::uint64_t seed) {
  return simulate_fitted(
      {.motion = motion, .off_plane = 0.15, .gyro_bias_rad_s = 0.002, .seed = seed});
}

double error_deg(const Initialization& result, const Simulation& truth) {
  return result.ok ? normal_error_deg(result, truth) : 90;
}

double joint_error_deg(const Simulation& truth, const MethodOptions& options = {}) {
  return error_deg(initialize_gpo_joint(truth.window, options, {}), truth);
}

double bound_deg(const Simulation& truth) {
  return *uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::bias)
              ->bound_unknown_bias_deg;
}

using Values = std::map<std::string, double>;

Values medians(const std::function<Values(std::uint64_t seed)>& values_of, int seeds = 20) {
  std::map<std::string, std::vector<double>> all;
  for (int seed = 1; seed <= seeds; ++seed)
    for (const auto& [name, value] : values_of(seed)) all[name].push_back(value);
  Values result;
  for (const auto& [name, values] : all) result[name] = median(values);
  return result;
}

class JointPattern : public testing::TestWithParam<Motion> {};

TEST_P(JointPattern, ReachesBoundOfUnknownBiasAndBeatsOtherMethods) {
  const auto values_of = [](std::uint64_t seed) -> Values {
    const Simulation truth = biased(GetParam(), seed);
    const Window& window = truth.window;
    return {{"bound", bound_deg(truth)},
            {"joint", joint_error_deg(truth)},
            {"gpo", error_deg(initialize_gpo(window, {}, {}), truth)},
            {"ba", error_deg(find_method("ba").initialize(window, {}, {}), truth)},
            {"pba", error_deg(find_method("pba").initialize(window, {}, {}), truth)}};
  };
  Values m = medians(values_of, 15);
  EXPECT_LT(m["joint"], 1.2 * m["bound"]) << "Huber's loss costs 3 % without outliers";
  EXPECT_LT(m["joint"], m["ba"]);
  EXPECT_LT(m["joint"], m["pba"]);
  EXPECT_LT(m["joint"], m["gpo"]);
}

INSTANTIATE_TEST_SUITE_P(, JointPattern, testing::ValuesIn(kObservableMotions));

TEST(GpoJoint, DependsOnPriorForMotionAlongNormal) {
  // A constant rotation of the camera is equivalent to a rotation of the normal.
  Values m = medians([](std::uint64_t seed) -> Values {
    const Simulation truth = biased(Motion::approach, seed);
    const Initialization result = initialize_gpo_joint(truth.window, {}, {});
    EXPECT_TRUE(result.ok);
    return {{"error", error_deg(result, truth)}, {"bound", bound_deg(truth)}};
  });
  EXPECT_LT(m["error"], 1.15 * m["bound"]);
  EXPECT_GT(m["bound"], 1);
}

TEST(GpoJoint, ReportsWrongMinima) {
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 504; ++seed) {
    const Simulation truth = biased(kMotions[seed % std::size(kMotions)], seed);
    const Initialization result = initialize_gpo_joint(truth.window, {}, {});
    if (!result.ok) continue;
    ++solved;
    EXPECT_LT(error_deg(result, truth), 5 * result.uncertainty->normal_sigma_deg) << seed;
    EXPECT_LT(result.rms_px / std::sqrt(2.0), 0.55) << seed;
  }
  EXPECT_GT(solved, 495);
}

TEST(GpoJoint, EqualsGpoForKnownRotations) {
  const Simulation truth = simulate_fitted({.motion = Motion::orbit});
  const Initialization joint =
      initialize_gpo_joint(truth.window, {.loss = Loss::squared, .shutter = Shutter::global}, {});
  const Initialization gpo = initialize_gpo(truth.window, {}, {});
  EXPECT_LT(angle_deg(joint.plane.normal, gpo.plane.normal), 1e-6);
  EXPECT_FALSE(joint.bias_rad_s);
}

TEST(GpoJoint, FreesRotationsWithoutGyroscope) {
  Values m = medians([](std::uint64_t seed) -> Values {
    Simulation truth = biased(Motion::wander, seed);
    truth.window.rotations = RotationModel::free;
    truth.window.gyro.reset();
    return {{"held", error_deg(initialize_gpo(truth.window, {}, {}), truth)},
            {"free", joint_error_deg(truth)}};
  });
  EXPECT_LT(m["free"], 0.5 * m["held"]);
}

/// Returns the root mean square error of the camera centers [d].
double camera_error(const Initialization& result, const Simulation& truth) {
  double squares = 0;
  for (std::size_t i = 0; i < truth.cameras.size(); ++i)
    squares += (result.cameras[i].p_wc - truth.cameras[i].p_wc).squaredNorm();
  return std::sqrt(squares / static_cast<double>(truth.cameras.size()));
}

/// The images are better than the gyroscope, and the gyroscope is better than none.
TEST(GpoJoint, WeighsNoisyGyroscopeAgainstImages) {
  Values m = medians([](std::uint64_t seed) -> Values {
    Simulation truth = simulate_fitted({.motion = Motion::wander,
                                        .noise_px = 0.1,
                                        .gyro_bias_rad_s = 0.002,
                                        .gyro_noise_rad_s = 0.005,
                                        .seed = seed});
    const auto error = [&] {
      const Initialization result =
          initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {});
      EXPECT_TRUE(result.ok) << result.reason;
      return camera_error(result, truth);
    };
    const double weighed = error();
    truth.window.gyro->noise_density = 0;
    const double exact = error();
    truth.window.rotations = RotationModel::free;
    return {{"weighed", weighed}, {"exact", exact}, {"ignored", error()}};
  });
  EXPECT_LT(m["weighed"], 0.8 * m["exact"]);
  EXPECT_LT(m["weighed"], 0.95 * m["ignored"]);
}

TEST(GpoJoint, FindsOffsetBetweenClocks) {
  std::vector<double> errors_s;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation truth = simulate_fitted(
        {.motion = Motion::wander, .gyro_bias_rad_s = 0.002, .gyro_offset_s = 0.005, .seed = seed});
    const Initialization result =
        successful(initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {}));
    if (!result.time_offset_s) continue;  // the images determine the rotations better
    errors_s.push_back(std::abs(*result.time_offset_s - 0.005));
    squares += std::pow(errors_s.back() / result.uncertainty->time_offset_sigma_s.value(), 2);
  }
  ASSERT_GT(errors_s.size(), 15);
  EXPECT_LT(median(errors_s), 0.001);
  const double mean = squares / static_cast<double>(errors_s.size());
  EXPECT_GT(mean, 0.4);
  EXPECT_LT(mean, 2);
}

TEST(GpoJoint, AddsTheFoundOffsetBetweenClocksToTheRecordedOne) {
  SimulationOptions options{
      .motion = Motion::wander, .gyro_bias_rad_s = 0.002, .gyro_offset_s = 0.005, .seed = 2};
  const auto solved = [&] {
    const Window window = simulate_fitted(options).window;
    const Initialization result =
        successful(initialize_gpo_joint(window, {.shutter = Shutter::global}, {}));
    EXPECT_EQ(uncertain_poses(window, result).time_offset_correction_s,
              result.time_offset_correction_s.value());
    return result;
  };
  const Initialization of_zero = solved();
  options.gyro_offset_s += 0.02;
  options.recorded_offset_s = 0.02;
  const Initialization recorded = solved();
  EXPECT_NEAR(of_zero.time_offset_s.value(), 0.005, 0.003);
  EXPECT_EQ(*of_zero.time_offset_s, of_zero.time_offset_correction_s.value());
  EXPECT_NEAR(*recorded.time_offset_s, *of_zero.time_offset_s + 0.02, 1e-9);
  EXPECT_NEAR(recorded.time_offset_correction_s.value(), *of_zero.time_offset_s, 1e-9);
}

TEST(GpoJoint, HuberLossResistsTracksThatSlip) {
  Values m = medians([](std::uint64_t seed) -> Values {
    Simulation truth = biased(Motion::orbit, seed);
    for (int i = 15; i < truth.window.frame_count(); ++i)
      truth.window.points_px[i].middleCols(140, 10).array() += 4;
    return {
        {"squared", joint_error_deg(truth, {.loss = Loss::squared, .shutter = Shutter::global})},
        {"huber", joint_error_deg(truth, {.loss = Loss::huber, .shutter = Shutter::global})}};
  });
  EXPECT_LT(m["huber"], 0.6 * m["squared"]);
}

/// The noise of the reference frame is common to all others; Sampson's error, which is of single
/// pairs, cannot use that.
TEST(GpoJoint, SampsonErrorMatchesTransferErrorWithNoisyReference) {
  Values m = medians([](std::uint64_t seed) -> Values {
    const Simulation truth = simulate_fitted({.motion = Motion::forward,
                                              .travel = 0.5,
                                              .gyro_bias_rad_s = 0.002,
                                              .reference_noise_px = 0.5,
                                              .seed = seed});
    return {{"transfer",
             joint_error_deg(truth, {.error = ErrorModel::transfer, .shutter = Shutter::global})},
            {"sampson",
             joint_error_deg(truth, {.error = ErrorModel::sampson, .shutter = Shutter::global})}};
  });
  EXPECT_LT(m["sampson"], 1.2 * m["transfer"]);
}

TEST(GpoJoint, CeresFindsSameMinimum) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = biased(Motion::wander, seed);
    const Initialization a = initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {});
    const Initialization b = initialize_gpo_joint(
        truth.window, {.solver = Solver::ceres, .shutter = Shutter::global}, {});
    EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 1e-5);
    EXPECT_LT((*a.bias_rad_s - *b.bias_rad_s).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace gpo::test
