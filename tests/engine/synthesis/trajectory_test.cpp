// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/trajectory.h"

#include "engine/synthesis/synthesize.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

Recipe perfect_recipe(int frames, double gyroscope_rate) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.trajectory.position.velocity *= 0.1;
  recipe.trajectory.look_at.velocity *= 0.1;
  recipe.trajectory.look_at.harmonics.push_back({{0.05, 0.08, 0.01}, 0.8, 0.3});
  recipe.trajectory.roll.harmonics.push_back({Eigen::Matrix<double, 1, 1>(0.1), 0.6, 1.0});
  recipe.frame_count = frames;
  recipe.gyroscope = {gyroscope_rate, 0, Eigen::Vector3d::Zero(), {}};
  return recipe;
}

TEST(Trajectory, CameraIsLevelAndLooksAtItsPoint) {
  const Recipe recipe = perfect_recipe(4, 200);
  Trajectory trajectory = recipe.trajectory;
  trajectory.roll = {};
  for (const double t : {-0.05, 0.0, 0.7}) {
    const Pose pose = camera_motion(trajectory, t).pose;
    EXPECT_NEAR(pose.R_wc.determinant(), 1, 1e-12);
    EXPECT_TRUE((pose.R_wc * pose.R_wc.transpose()).isIdentity(1e-12));
    // The y axis of an image points down, its x axis is level.
    EXPECT_LT(pose.R_wc(2, 1), 0);
    EXPECT_NEAR(pose.R_wc(2, 0), 0, 1e-12);
  }
  const Pose first = camera_motion(trajectory, 0).pose;
  const auto& wobble = trajectory.look_at.harmonics[0];
  const Eigen::Vector3d target =
      to_camera(first, trajectory.look_at.start + wobble.amplitude * std::sin(wobble.phase));
  EXPECT_NEAR(target.head<2>().norm(), 0, 1e-12);
  EXPECT_GT(target.z(), 0);
}

TEST(Trajectory, IntegratedRatesAgreeWithRotations) {
  const Recipe recipe = perfect_recipe(61, 10000);
  const auto samples = simulate_imu(recipe);
  const Eigen::Matrix3d R_body_camera = recipe.T_body_camera.R_wc;
  const auto body_rotation = [&](std::int64_t ns) -> Eigen::Matrix3d {
    return camera_motion(recipe.trajectory, trajectory_seconds(recipe, ns)).pose.R_wc *
           R_body_camera.transpose();
  };
  Eigen::Matrix3d R = body_rotation(samples.front().timestamp_ns);
  double worst = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = 1e-9 * (samples[i].timestamp_ns - samples[i - 1].timestamp_ns);
    R = R * so3_exp(0.5 * dt * (samples[i].rate_b + samples[i - 1].rate_b));
    const Eigen::Matrix3d truth = body_rotation(samples[i].timestamp_ns);
    worst = std::max(worst, so3_log(R.transpose() * truth).norm());
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(samples.size(), 20000U);
}

TEST(Trajectory, VelocityAndForceAgreeWithFiniteDifferences) {
  const Recipe recipe = perfect_recipe(61, 200);
  const auto body = [&](double t) {
    return body_motion(recipe.trajectory, recipe.T_body_camera, t);
  };
  const double h = 1e-4;
  for (const double t : {0.1, 0.5, 1.3}) {
    const Eigen::Vector3d velocity = (body(t + h).pose.p_wc - body(t - h).pose.p_wc) / (2 * h);
    EXPECT_LT((body(t).velocity_w - velocity).norm(), 1e-6);
    const Eigen::Vector3d acceleration =
        (body(t + h).velocity_w - body(t - h).velocity_w) / (2 * h);
    const Eigen::Vector3d force = body(t).pose.R_wc * body(t).specific_force_b;
    EXPECT_LT((force - acceleration - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-5);
  }
}

TEST(SimulatedImu, CoversTheFramesWithoutTheirTimes) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const auto samples = simulate_imu(recipe);
  EXPECT_LE(samples.front().timestamp_ns, recipe.start_ns - 95'000'000);
  EXPECT_GE(samples.back().timestamp_ns, frame_timestamp_ns(recipe, 3) + 95'000'000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (int frame = 0; frame < recipe.frame_count; ++frame)
      EXPECT_NE(samples[i].timestamp_ns, frame_timestamp_ns(recipe, frame));
    EXPECT_EQ(samples[i].timestamp_ns - samples[0].timestamp_ns, 5'000'000 * std::int64_t(i));
  }
}

TEST(SimulatedImu, HasNoiseAndBiasOfTheRecipe) {
  Recipe recipe = perfect_recipe(3001, 200);
  const auto perfect = simulate_imu(recipe);
  recipe.gyroscope = {200, 0.0002, Eigen::Vector3d(0.006, -0.004, 0.003), {}};
  const auto real = simulate_imu(recipe);
  ASSERT_EQ(real.size(), perfect.size());
  const auto n = static_cast<double>(real.size());
  const double sigma = 0.0002 * std::sqrt(200.0);
  for (int k = 0; k < 3; ++k) {
    double sum = 0, squares = 0, neighbors = 0, previous = 0;
    for (std::size_t i = 0; i < real.size(); ++i) {
      const double noise = real[i].rate_b[k] - perfect[i].rate_b[k] - recipe.gyroscope.bias[k];
      sum += noise;
      squares += noise * noise;
      neighbors += noise * previous;
      previous = noise;
    }
    EXPECT_LT(std::abs(sum / n), 4 * sigma / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(squares / n) / sigma, 1, 4 / std::sqrt(2 * n));
    EXPECT_LT(std::abs(neighbors / squares), 4 / std::sqrt(n));
    EXPECT_EQ(real[7].specific_force_b, perfect[7].specific_force_b);
  }
}

}  // namespace
}  // namespace gpo
