// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/gpo_joint.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/ba.h"
#include "engine/methods/certainty/uncertainty.h"
#include "engine/methods/gpo.h"
#include "engine/methods/methods.h"
#include "engine/methods/pba.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// An uncorrected bias, 15 % of the tracks off the plane.
Simulation biased(Motion motion, std::uint64_t seed) {
  return with_fitted_homographies(
      simulate({.motion = motion, .off_plane = 0.15, .gyro_bias_rad_s = 0.002, .seed = seed}));
}

double error_deg(const Initialization& result, const Simulation& truth) {
  return result.ok ? angle_deg(result.plane.normal, truth.plane.normal) : 90;
}

struct Medians {
  double joint, bound, ba, pba, gpo;  ///< [deg]
};

Medians medians(Motion motion, std::uint64_t seeds) {
  std::map<std::string, std::vector<double>> errors;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Simulation truth = biased(motion, seed);
    const Window& window = truth.window;
    const auto u = uncertainty_of(window, truth.plane, truth.cameras, RotationModel::bias);
    errors["bound"].push_back(*u->bound_unknown_bias_deg);
    errors["joint"].push_back(error_deg(initialize_gpo_joint(window, {}, {}), truth));
    errors["gpo"].push_back(error_deg(initialize_gpo(window, {}, {}), truth));
    errors["ba"].push_back(error_deg(initialize_ba(window, {}), truth));
    errors["pba"].push_back(error_deg(initialize_pba(window, {}), truth));
  }
  return {median(errors["joint"]),
          median(errors["bound"]),
          median(errors["ba"]),
          median(errors["pba"]),
          median(errors["gpo"])};
}

class JointPattern : public testing::TestWithParam<Motion> {};

TEST_P(JointPattern, ReachesTheBoundOfAnUnknownBiasAndBeatsTheOthers) {
  const Medians m = medians(GetParam(), 15);
  EXPECT_LT(m.joint, 1.2 * m.bound) << "Huber's loss costs 3 % where no track is wrong";
  EXPECT_LT(m.joint, m.ba);
  EXPECT_LT(m.joint, m.pba);
  EXPECT_LT(m.joint, m.gpo);
}

INSTANTIATE_TEST_SUITE_P(,
                         JointPattern,
                         testing::Values(Motion::sideways,
                                         Motion::orbit,
                                         Motion::forward,
                                         Motion::oblique,
                                         Motion::up_down,
                                         Motion::wander,
                                         Motion::arc));

TEST(GpoJoint, MotionAlongTheNormalIsNoBetterThanItsPriorAndSaysSo) {
  // A steady turn of the camera and a turn of the normal look alike there.
  std::vector<double> errors;
  std::vector<double> bounds;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation truth = biased(Motion::approach, seed);
    const Initialization result = initialize_gpo_joint(truth.window, {}, {});
    ASSERT_TRUE(result.ok);
    errors.push_back(error_deg(result, truth));
    const auto u = uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::bias);
    bounds.push_back(*u->bound_unknown_bias_deg);
  }
  EXPECT_LT(median(errors), 1.15 * median(bounds));
  EXPECT_GT(median(bounds), 1);
}

TEST(GpoJoint, NeverEndsInAWrongMinimumWithoutSayingSo) {
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

TEST(GpoJoint, OfAnAbsurdBiasSaysSo) {
  Simulation truth = with_fitted_homographies(
      simulate({.motion = Motion::wander, .gyro_bias_rad_s = 0.15, .seed = 2}));
  const Initialization result =
      initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {});
  if (result.uncertainty && result.uncertainty->rotations == RotationModel::free) return;
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("standard deviations from what is known"));
  ASSERT_TRUE(result.refused);  // what was found can be looked at
  EXPECT_TRUE(result.cameras.empty());
  EXPECT_EQ(std::ssize(result.refused->cameras), truth.window.frame_count());
  EXPECT_NEAR(result.refused->plane.normal.norm(), 1, 1e-12);
}

TEST(GpoJoint, IsGpoWhereTheRotationsAreKnown) {
  const Simulation truth = with_fitted_homographies(simulate({.motion = Motion::orbit}));
  const Initialization joint =
      initialize_gpo_joint(truth.window, {.loss = Loss::squared, .shutter = Shutter::global}, {});
  const Initialization gpo = initialize_gpo(truth.window, {}, {});
  EXPECT_LT(angle_deg(joint.plane.normal, gpo.plane.normal), 1e-6);
  EXPECT_FALSE(joint.bias_rad_s);
}

TEST(GpoJoint, WithoutAGyroscopeFreesTheRotations) {
  std::vector<double> held;
  std::vector<double> freed;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation truth = biased(Motion::wander, seed);
    truth.window.rotations = RotationModel::free;
    truth.window.gyro.reset();
    held.push_back(error_deg(initialize_gpo(truth.window, {}, {}), truth));
    freed.push_back(error_deg(initialize_gpo_joint(truth.window, {}, {}), truth));
  }
  EXPECT_LT(median(freed), 0.5 * median(held));
}

/// The root mean square of the cameras' errors [d].
double camera_error(const Initialization& result, const Simulation& truth) {
  double squares = 0;
  for (std::size_t i = 0; i < truth.cameras.size(); ++i)
    squares += (result.cameras[i].p_wc - truth.cameras[i].p_wc).squaredNorm();
  return std::sqrt(squares / static_cast<double>(truth.cameras.size()));
}

/// Pictures that are better than the gyroscope, and a gyroscope that is better than none.
TEST(GpoJoint, WeighsANoisyGyroscopeAgainstTheImages) {
  std::vector<double> weighed, trusted, ignored;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation truth = with_fitted_homographies(simulate({.motion = Motion::wander,
                                                          .noise_px = 0.1,
                                                          .gyro_bias_rad_s = 0.002,
                                                          .gyro_noise_rad_s = 0.005,
                                                          .seed = seed}));
    const auto error = [&] {
      const Initialization result =
          initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {});
      EXPECT_TRUE(result.ok) << result.reason;
      return camera_error(result, truth);
    };
    weighed.push_back(error());
    truth.window.gyro->noise_density = 0;
    trusted.push_back(error());
    truth.window.rotations = RotationModel::free;
    ignored.push_back(error());
  }
  EXPECT_LT(median(weighed), 0.8 * median(trusted));
  EXPECT_LT(median(weighed), 0.95 * median(ignored));
}

TEST(GpoJoint, FindsTheOffsetBetweenTheClocks) {
  std::vector<double> errors_s;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation truth = with_fitted_homographies(simulate({.motion = Motion::wander,
                                                                .gyro_bias_rad_s = 0.002,
                                                                .gyro_offset_s = 0.005,
                                                                .seed = seed}));
    const Initialization result =
        initialize_gpo_joint(truth.window, {.shutter = Shutter::global, .time_offset = true}, {});
    ASSERT_TRUE(result.ok) << result.reason;
    if (!result.time_offset_s) continue;  // the pictures knew the rotations better
    errors_s.push_back(std::abs(*result.time_offset_s - 0.005));
  }
  ASSERT_GT(errors_s.size(), 15);
  EXPECT_LT(median(errors_s), 0.001);
}

TEST(GpoJoint, HuberHoldsTracksThatSlipped) {
  std::vector<double> squared;
  std::vector<double> huber;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation truth = biased(Motion::orbit, seed);
    for (int i = 15; i < truth.window.frame_count(); ++i) {
      for (int j = 140; j < 150; ++j) truth.window.points_px[i].col(j).array() += 4;
    }
    const MethodOptions least_squares{.loss = Loss::squared, .shutter = Shutter::global};
    const MethodOptions robust{.loss = Loss::huber, .shutter = Shutter::global};
    squared.push_back(error_deg(initialize_gpo_joint(truth.window, least_squares, {}), truth));
    huber.push_back(error_deg(initialize_gpo_joint(truth.window, robust, {}), truth));
  }
  EXPECT_LT(median(huber), 0.6 * median(squared));
}

/// Noise of the reference frame is the same in all others; Sampson, who takes each pair alone, does
/// not know that, and so gains nothing.
TEST(GpoJoint, SampsonIsAboutAsGoodWithANoisyReference) {
  std::vector<double> transfer;
  std::vector<double> sampson;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation truth = with_fitted_homographies(simulate({.motion = Motion::forward,
                                                                .travel = 0.5,
                                                                .gyro_bias_rad_s = 0.002,
                                                                .reference_noise_px = 0.5,
                                                                .seed = seed}));
    const MethodOptions one_sided{.shutter = Shutter::global};
    const MethodOptions shared{.error = ErrorModel::sampson, .shutter = Shutter::global};
    transfer.push_back(error_deg(initialize_gpo_joint(truth.window, one_sided, {}), truth));
    sampson.push_back(error_deg(initialize_gpo_joint(truth.window, shared, {}), truth));
  }
  EXPECT_LT(median(sampson), 1.2 * median(transfer));
}

TEST(GpoJoint, CeresEndsInTheSamePlace) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = biased(Motion::wander, seed);
    const MethodOptions ours{.shutter = Shutter::global};
    MethodOptions theirs = ours;
    theirs.solver = Solver::ceres;
    const Initialization a = initialize_gpo_joint(truth.window, ours, {});
    const Initialization b = initialize_gpo_joint(truth.window, theirs, {});
    EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 1e-5);
    EXPECT_LT((*a.bias_rad_s - *b.bias_rad_s).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace gpo::test
