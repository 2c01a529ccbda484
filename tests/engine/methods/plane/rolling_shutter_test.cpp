// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/rolling_shutter.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "tests/engine/simulated_window.h"

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

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
    EXPECT_LT(angle_deg(rolling.plane.normal, truth.plane.normal),
              0.3 * angle_deg(global.plane.normal, truth.plane.normal));
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
