// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"
#include "engine/diagnosis/diagnosis.h"
#include "engine/geometry/pose.h"
#include "engine/methods/initializers.h"
#include "tests/engine/simulated_window.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

/// Sensors of a tripod, over the window.
Gyroscope on_tripod(const Window& window, bool accelerometer = true) {
  Gyroscope gyroscope;
  gyroscope.bias_rad_s = {0.004, -0.003, 0.002};
  gyroscope.bias_sigma_rad_s = 0.002;
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss;
  const auto noise = [&] { return Vector3d(gauss(random), gauss(random), gauss(random)); };
  const auto& times_ns = window.timestamps_ns;
  for (std::int64_t t = times_ns.front() - 50'000'000; t < times_ns.back() + 50'000'000;
       t += 5'000'000) {
    gyroscope.timestamps_ns.push_back(t);
    gyroscope.rates_rad_s.emplace_back(gyroscope.bias_rad_s + 0.002 * noise());
    if (accelerometer)
      gyroscope.accelerations_m_s2.emplace_back(Vector3d(0, -5.6, -8.05) + 0.02 * noise());
  }
  return gyroscope;
}

/// A result whose camera has these poses at times from 0 to 1.
Initialization result_of(const Window& window, const std::function<Pose(double time)>& pose) {
  Initialization result;
  result.ok = true;
  for (int i = 0; i < window.frame_count(); ++i)
    result.cameras.push_back(pose(i / (window.frame_count() - 1.0)));
  return result;
}

Pose even(double time) { return {Eigen::Matrix3d::Identity(), {0.3 * time, 0, 0}}; }
Pose uneven(double time) { return {Eigen::Matrix3d::Identity(), {0.1 * std::sin(9 * time), 0, 0}}; }
Pose nodding(double time) { return {so3_exp({0.2 * time, 0, 0}), {0.3 * time, 0, 0}}; }

std::vector<Finding> found(const Window& window,
                           const Gyroscope& gyroscope,
                           const Initialization& result,
                           std::span<const std::int64_t> ids = {}) {
  return findings_of({.gyroscope = &gyroscope, .window = &window, .ids = ids, .result = &result},
                     {Of::window});
}

Window moving_tracks() { return simulate({.motion = Motion::sideways, .seed = 2}).window; }

void expect_rests(const std::vector<Finding>& findings, const char* evidence) {
  ASSERT_EQ(findings.size(), 1U) << evidence;
  EXPECT_EQ(findings[0].key, "camera-at-rest");
  EXPECT_EQ(findings[0].level, Level::degenerate);
  EXPECT_THAT(findings[0].sentence, HasSubstr("the camera rests, the plane moves"));
  EXPECT_THAT(findings[0].sentence, HasSubstr(evidence));
  EXPECT_EQ(findings[0].advice, "move the camera and not the plane");
}

TEST(CameraAtRest, IsSeenByRotationsAndAccelerationsOfTheResult) {
  const Window window = moving_tracks();
  const Gyroscope tripod = on_tripod(window);
  expect_rests(found(window, tripod, result_of(window, nodding)), "the result tilts by ");
  expect_rests(found(window, tripod, result_of(window, uneven)), "the path needs a plane within ");
}

TEST(CameraAtRest, IsSeenByTracksThatDoNotMove) {
  constexpr int kStill = 12;
  Window window = moving_tracks();
  const int moving = window.track_count();
  std::vector<std::int64_t> ids;
  for (int k = 0; k < moving + kStill; ++k) ids.push_back(100 + k);
  const Gyroscope tripod = on_tripod(window);
  EXPECT_THAT(found(window, tripod, result_of(window, even), ids), IsEmpty());
  for (int k = 0; k < kStill; ++k) window.static_tracks.push_back(moving + k);
  for (int i = 0; i < window.frame_count(); ++i) {
    window.points_px[i].conservativeResize(2, moving + kStill);
    window.points_px[i].rightCols(kStill).setConstant(std::numeric_limits<double>::quiet_NaN());
    window.inlier[i].resize(moving + kStill, false);
  }
  const auto findings = found(window, tripod, result_of(window, even), ids);
  const Finding* rests = find_finding(findings, "camera-at-rest");
  ASSERT_TRUE(rests);
  expect_rests({*rests}, "12 tracks do not move");
  EXPECT_EQ(rests->tracks.size(), 12U);
  EXPECT_EQ(rests->tracks.front(), 100 + moving);
  EXPECT_EQ(find_finding(found(window, on_tripod(window, false), result_of(window, even), ids),
                         "camera-at-rest"),
            nullptr)
      << "without an accelerometer";
  window.static_tracks.resize(9);
  EXPECT_EQ(find_finding(found(window, tripod, result_of(window, even), ids), "camera-at-rest"),
            nullptr)
      << "too few";
}

TEST(CameraAtRest, CountsRejectedSolutions) {
  const Window window = moving_tracks();
  const Initialization failure = refused("no convergence", result_of(window, nodding));
  expect_rests(found(window, on_tripod(window), failure), "the result tilts by ");
}

TEST(CameraAtRest, IsOnlyDoubtedWithoutAnAccelerometer) {
  const Window window = moving_tracks();
  const Gyroscope alone = on_tripod(window, false);
  const auto findings = found(window, alone, result_of(window, nodding));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Level::weak);
  EXPECT_THAT(findings[0].sentence, HasSubstr("the gyroscope rests, the result turns by "));
  EXPECT_THAT(found(window, alone, result_of(window, uneven)), IsEmpty());
}

TEST(CameraAtRest, NeedsSensorsAtRestAndAPlaneThatMoves) {
  const Window window = moving_tracks();
  const Initialization result = result_of(window, nodding);
  Gyroscope by_hand = on_tripod(window);
  for (std::size_t k = 0; k < by_hand.rates_rad_s.size(); ++k)
    by_hand.rates_rad_s[k].x() += 0.05 * std::sin(0.02 * static_cast<double>(k));
  EXPECT_THAT(found(window, by_hand, result), IsEmpty());
  Window at_rest = window;
  for (auto& points : at_rest.points_px) points = at_rest.points_px.front();
  EXPECT_THAT(found(at_rest, on_tripod(window), result), IsEmpty());
  Gyroscope elsewhere = on_tripod(window);
  for (std::int64_t& t : elsewhere.timestamps_ns) t += 10'000'000'000;
  EXPECT_THAT(found(window, elsewhere, result), IsEmpty());
}

/// Findings on a bias in standard deviations of its prior.
std::vector<Finding> biased(double sigmas, bool estimated) {
  Window window = moving_tracks();
  window.gyro = GyroSensitivity{.prior_sigma_rad_s = 0.002};
  Initialization result;
  result.ok = true;
  const Vector3d bias_rad_s(0, 0.002 * sigmas, 0);
  if (estimated)
    result.bias_rad_s = bias_rad_s;
  else
    window.gyro->bias_rad_s = bias_rad_s;
  return check::contradicted_bias({.window = &window, .result = &result});
}

TEST(GyroscopeBias, ContradictsItsPriorBySixStandardDeviations) {
  for (const bool estimated : {true, false}) {
    EXPECT_THAT(biased(5, estimated), IsEmpty());
    for (const double sigmas : {7., 120., std::numeric_limits<double>::quiet_NaN()}) {
      const auto findings = biased(sigmas, estimated);
      ASSERT_EQ(findings.size(), 1U) << sigmas;
      EXPECT_EQ(findings[0].level, Level::degenerate);
    }
    EXPECT_THAT(biased(120, estimated)[0].sentence,
                HasSubstr("0.240 rad/s (13.8 deg/s), 120 standard deviations from its prior"));
  }
}

TEST(GyroscopeBias, IsComparedWithItsPriorAndWithAnyGyroscope) {
  Window window;
  window.gyro = GyroSensitivity{.prior_rad_s = Vector3d(0, 0.3, 0), .prior_sigma_rad_s = 0.1};
  Gyroscope gyroscope;
  gyroscope.bias_source = "a rest";
  Initialization result;
  result.ok = true;
  const auto found_with = [&](double bias_rad_s) {
    result.bias_rad_s = Vector3d(0, bias_rad_s, 0);
    return check::contradicted_bias(
        {.gyroscope = &gyroscope, .window = &window, .result = &result});
  };
  EXPECT_THAT(found_with(0.45), IsEmpty());
  ASSERT_EQ(found_with(0.56).size(), 1U) << "no gyroscope has such a bias";
  EXPECT_THAT(found_with(0.56)[0].sentence,
              HasSubstr("3 standard deviations from its prior (a rest)"));
}

TEST(GyroscopeBias, RefusesAWrongMinimum) {
  const Simulation truth =
      simulate_fitted({.motion = Motion::wander, .gyro_bias_rad_s = 0.15, .seed = 2});
  const Method& method = MethodChoice("gpo_joint").row();
  const Initialization found = initialize_gpo_joint(truth.window, {.shutter = Shutter::global}, {});
  ASSERT_TRUE(found.ok) << found.reason;
  const Initialization result = assessed(method, truth.window, found);
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("standard deviations from its prior"));
  ASSERT_TRUE(result.refused);  // for display
  EXPECT_TRUE(result.cameras.empty());
  EXPECT_EQ(std::ssize(result.refused->cameras), truth.window.frame_count());
  EXPECT_NEAR(result.refused->plane.normal.norm(), 1, 1e-12);
}

}  // namespace
}  // namespace gpo::test
