// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/time_offset.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

constexpr double kFrameInterval_s = 1.0 / 30;

std::int64_t ns(double seconds) { return std::llround(1e9 * seconds); }

/// Pose of a camera in a hand at a time.
Pose held(double t) {
  return {so3_exp({0.3 * std::sin(2.1 * t), 0.4 * std::sin(3.3 * t + 1), 0.2 * std::sin(5.2 * t)}),
          {0.2 * std::sin(1.3 * t), 0.1 * t, 0.3}};
}

Eigen::Vector3d noise(double sigma, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, sigma);
  return {normal(random), normal(random), normal(random)};
}

struct Clocks {
  double offset_s = 0.02;  ///< recording - result
  double sigma_rad = 3e-4;
  double bias_rad_s = 0;
  Pose T_posed_camera = {};
  int frames = 300;
  double motion = 1;  ///< 0: a constant rate
};

/// Returns a result at 30 Hz and rotations of the reference, whose frames are at other times.
std::pair<ResultPoses, ClockReference> made(const Clocks& clocks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto pose = [&](double t) {
    return clocks.motion > 0 ? held(t) : Pose{so3_exp({0, 0.3 * t, 0}), {t, 0, 0}};
  };
  ResultPoses result{.layout = "made", .timestamps_ns = {}, .poses = {}};
  ClockReference reference{
      .source = "made", .timestamps_ns = {}, .R_wc = {}, .rates_are_biased = clocks.bias_rad_s > 0};
  Eigen::Matrix3d drift = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d before = pose(0).R_wc;
  for (int i = 0; i < clocks.frames; ++i) {
    const double t = i * kFrameInterval_s;
    Pose one = pose(t + 0.007) * inverse(clocks.T_posed_camera);
    one.R_wc = one.R_wc * so3_exp(noise(clocks.sigma_rad, random));
    result.timestamps_ns.push_back(ns(t + 0.007 - clocks.offset_s));
    result.poses.push_back(one);
    const Eigen::Matrix3d R = pose(t).R_wc;
    drift = drift * (before.transpose() * R) *
            so3_exp(Eigen::Vector3d(clocks.bias_rad_s, 0, -clocks.bias_rad_s) * kFrameInterval_s);
    before = R;
    reference.timestamps_ns.push_back(ns(t));
    reference.R_wc.push_back(drift * so3_exp(noise(clocks.sigma_rad, random)));
  }
  return {result, reference};
}

void expect_found(const Clocks& clocks) {
  double squares = 0;
  constexpr int kTrials = 20;
  for (int seed = 1; seed <= kTrials; ++seed) {
    const auto [result, reference] = made(clocks, seed);
    const auto found = estimate_time_offset(result, clocks.T_posed_camera, reference);
    ASSERT_TRUE(found) << seed;
    EXPECT_LT(found->sigma_s, 1.5e-3);
    EXPECT_NEAR(found->seconds, clocks.offset_s, 4.5 * found->sigma_s + 1e-5) << seed;
    squares += std::pow((found->seconds - clocks.offset_s) / found->sigma_s, 2);
  }
  // Standard deviations are neither much too small nor much too large.
  EXPECT_LT(squares / kTrials, 3);
  EXPECT_GT(squares / kTrials, 0.1);
}

TEST(TimeOffset, IsFoundWithItsStandardDeviation) {
  for (const double offset_s : {0.02, 0.0, -0.0123, 0.31}) expect_found({.offset_s = offset_s});
}

TEST(TimeOffset, AllowsForTheBiasOfAGyroscopeAndForBodyPoses) {
  expect_found({.bias_rad_s = 0.05});
  expect_found({.T_posed_camera = {so3_exp({0.1, -1.6, 0.4}), {0.1, 0, 0}}});
}

TEST(TimeOffset, IsUndeterminedWithoutVaryingRotationOrOverlap) {
  const auto offset = [](const Clocks& clocks) {
    const auto [result, reference] = made(clocks, 3);
    return estimate_time_offset(result, {}, reference);
  };
  EXPECT_TRUE(offset({}));
  EXPECT_FALSE(offset({.motion = 0}));
  EXPECT_FALSE(offset({.offset_s = 100}));
  EXPECT_FALSE(offset({.frames = 5}));
}

TEST(TimeOffset, IgnoresAFewJumps) {
  auto [result, reference] = made({}, 4);
  for (std::size_t i = 150; i < result.poses.size(); ++i)
    result.poses[i] = Pose{so3_exp({0, 0, 0.4}), {}} * result.poses[i];
  result.poses[40].R_wc = result.poses[40].R_wc * so3_exp({0.5, 0, 0});
  const auto found = estimate_time_offset(result, {}, reference);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->seconds, 0.02, 2e-3);
}

TEST(PoseAt, InterpolatesBetweenTwoPosesAndNeverBeyondThem) {
  ResultPoses result{.layout = "made", .timestamps_ns = {100, 200, 400}, .poses = {}};
  for (const double angle : {0.0, 0.8, 1.0})
    result.poses.push_back({so3_exp({0, angle, 0}), {10 * angle, 0, 1}});
  const auto middle = pose_at(result, 125, 100);
  ASSERT_TRUE(middle);
  EXPECT_TRUE(middle->R_wc.isApprox(so3_exp({0, 0.2, 0}), 1e-12));
  EXPECT_TRUE(middle->p_wc.isApprox(Eigen::Vector3d(2, 0, 1), 1e-12));
  EXPECT_TRUE(pose_at(result, 100, 0)->R_wc.isIdentity());
  EXPECT_TRUE(pose_at(result, 400, 0));
  EXPECT_FALSE(pose_at(result, 99, 1000));
  EXPECT_FALSE(pose_at(result, 401, 1000));
  EXPECT_FALSE(pose_at(result, 300, 199)) << "the poses are 200 ns apart";
  EXPECT_TRUE(pose_at(result, 300, 200));
}

}  // namespace
}  // namespace gpo::test
