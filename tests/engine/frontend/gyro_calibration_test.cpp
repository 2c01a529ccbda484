// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotations.h"
#include "engine/geometry/pose.h"
#include "engine/window/gyroscope.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Motion;
using test::simulate;
using test::Simulation;

constexpr double kFrame_s = 0.033333333;
const Vector3d kBias(0.004, -0.006, 0.003);

/// A gyroscope of 1 kHz that turns as the simulated camera does, with constant rates between
/// frames, and reads a bias that it does not know of. Its axes are turned against the camera's.
Gyroscope biased_gyroscope(const Simulation& s) {
  Gyroscope gyroscope;
  gyroscope.bias_sigma_rad_s = 0.01;
  gyroscope.R_gyro_camera = so3_exp({0.3, -1.2, 0.5});
  const auto& times = s.window.timestamps_ns;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const Vector3d rate_c =
        so3_log(s.cameras[i].R_wc.transpose() * s.cameras[i + 1].R_wc) / kFrame_s;
    for (std::int64_t t = times[i] + 500'000; t < times[i + 1]; t += 1'000'000) {
      gyroscope.timestamps_ns.push_back(t);
      gyroscope.lines.push_back(static_cast<int>(gyroscope.lines.size()) + 2);
      gyroscope.rates_rad_s.push_back(gyroscope.R_gyro_camera * rate_c + kBias);
    }
  }
  return gyroscope;
}

double last_error_deg(const Rotations& rotations, const Simulation& s) {
  return degrees(so3_log(rotations.R_wc.back().transpose() * s.cameras.back().R_wc).norm());
}

TEST(GyroCalibration, FindsTheBiasThatExplainsExactRotations) {
  const Simulation s = simulate({.motion = Motion::orbit, .seed = 4});
  const Gyroscope gyroscope = biased_gyroscope(s);
  const Vector3d bias =
      fit_gyro_bias(gyroscope, s.window.timestamps_ns, {s.window.R_wc, ""}).bias_rad_s;
  // The prior at zero draws it in by (0.001 rad / (0.01 rad/s x 0.58 s))^2.
  EXPECT_LT((bias - kBias).norm(), 0.08 * kBias.norm());
}

TEST(GyroCalibration, AFewWrongVisualRotationsDoNotMoveTheBias) {
  const Simulation s = simulate({.motion = Motion::orbit, .seed = 4});
  std::vector<Matrix3d> R_wc = s.window.R_wc;
  for (const int i : {7, 15, 22}) R_wc[i] = R_wc[i] * so3_exp({0.2, -0.1, 0.1});
  const Vector3d bias =
      fit_gyro_bias(biased_gyroscope(s), s.window.timestamps_ns, {R_wc, ""}).bias_rad_s;
  EXPECT_LT((bias - kBias).norm(), 0.15 * kBias.norm());
}

TEST(GyroCalibration, ShortWindowKeepsTheBiasThatTheGyroscopeComesWith) {
  const Simulation s = simulate({.motion = Motion::orbit, .seed = 4});
  const std::span times(s.window.timestamps_ns.data(), 4);
  const std::vector<Matrix3d> R_wc(s.window.R_wc.begin(), s.window.R_wc.begin() + 4);
  // By the same ratio: 0.07 s, so that 0.33 of the bias remain.
  EXPECT_LT(fit_gyro_bias(biased_gyroscope(s), times, {R_wc, ""}).bias_rad_s.norm(),
            0.4 * kBias.norm());
}

// An approach says little of the normal, hence of the rotations: there it only must not harm.
TEST(GyroCalibration, BringsTheRotationsOfABiasedGyroscopeNearerToTheTruth) {
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::approach, Motion::wander}) {
    std::vector<double> raw;
    std::vector<double> calibrated;
    for (std::uint64_t seed = 1; seed <= 11; ++seed) {
      const Simulation s = simulate({.motion = motion, .seed = seed});
      const Gyroscope gyroscope = biased_gyroscope(s);
      raw.push_back(last_error_deg({gyro_rotations(gyroscope, s.window.timestamps_ns), ""}, s));
      const Rotations rotations = calibrated_gyro_rotations(gyroscope, s.window);
      ASSERT_EQ(rotations.reason, "") << static_cast<int>(motion) << " seed " << seed;
      ASSERT_TRUE(rotations.gyro);
      calibrated.push_back(last_error_deg(rotations, s));
    }
    std::ranges::sort(raw);
    std::ranges::sort(calibrated);
    const double factor = motion == Motion::approach ? 1.1 : 0.4;
    EXPECT_LT(calibrated[5], factor * raw[5]) << static_cast<int>(motion);
  }
}

// What averaging alone cannot tell, the gyroscope tells.
TEST(GyroCalibration, TellsWhichOfTwoPlanesIsTheTrueOne) {
  int averaging_refused = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation s = simulate({.motion = Motion::approach, .travel = 0.1, .seed = seed});
    const bool refused = !averaged_rotations(s.window).reason.empty();
    averaging_refused += refused ? 1 : 0;
    const Rotations rotations = calibrated_gyro_rotations(biased_gyroscope(s), s.window);
    ASSERT_EQ(rotations.reason, "");
    EXPECT_LT(last_error_deg(rotations, s), 1.0) << "seed " << seed;
  }
  RecordProperty("averaging_refused_of_10", averaging_refused);
}

TEST(GyroCalibration, HasNoAnswerForAWindowWithoutInliers) {
  Simulation s = simulate({});
  for (auto& frame : s.window.inlier) frame.assign(150, false);
  const Rotations rotations = calibrated_gyro_rotations(biased_gyroscope(s), s.window);
  EXPECT_TRUE(rotations.R_wc.empty());
  EXPECT_THAT(rotations.reason, ::testing::HasSubstr("too few tracks join frame 1"));
}

}  // namespace
}  // namespace gpo
