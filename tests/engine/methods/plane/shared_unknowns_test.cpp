// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/methods/plane/plane_motion.h"
#include "tests/engine/simulated_window.h"

#include <cmath>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;

TEST(GyroColumns, AreDifferenceQuotientsOfANoisyGyroscopesRotation) {
  const Simulation truth = simulate({.motion = Motion::wander, .gyro_bias_rad_s = 0.01, .seed = 4});
  const int frame = 17;
  PlaneMotion motion = motion_at_rest(truth.window);
  motion.bias_rad_s += Vector3d(0.3, -0.2, 0.1);
  motion.time_offset_s = 0.1;
  motion.gyro_noise_rad.assign(truth.window.frame_count(), Vector3d(0.2, -0.3, 0.1));
  const GyroColumns columns = gyro_columns(truth.window, motion, frame, 4);
  const auto rotation = [&](int unknown, double step) {
    PlaneMotion moved = motion;
    (unknown == 3 ? moved.time_offset_s : moved.bias_rad_s[unknown]) += step;
    return gyro_rotation(truth.window, frame, moved);
  };
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 4; ++k) {
    const Vector3d numeric =
        so3_log(rotation(k, -kStep).transpose() * rotation(k, kStep)) / (2 * kStep);
    EXPECT_LT((columns.col(k) - numeric).norm(), 1e-7) << k;
  }
}

TEST(GyroNoise, GrowsWithTheRootOfTime) {
  Simulation truth = simulate({.frames = 17, .gyro_bias_rad_s = 0});
  truth.window.gyro->noise_density = 1e-3;
  EXPECT_EQ(gyro_noise_sigma_rad(truth.window, 0), 0);
  EXPECT_NEAR(gyro_noise_sigma_rad(truth.window, 4), 1e-3 * std::sqrt(4 / 30.0), 1e-9);
  EXPECT_NEAR(gyro_noise_sigma_rad(truth.window, 16), 2e-3 * std::sqrt(4 / 30.0), 1e-9);
}

}  // namespace
}  // namespace gpo::test
