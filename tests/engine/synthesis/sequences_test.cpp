// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/recipe.h"

#include <algorithm>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

Recipe sequence(const std::string& name) {
  return read_recipe(std::filesystem::path(GPO_SOURCE_DIR) / "sequences" / (name + ".yaml"));
}

Pose camera(const Recipe& recipe, int frame) {
  const double t = trajectory_seconds(recipe, frame_timestamp_ns(recipe, frame));
  return camera_motion(recipe.trajectory, t).pose;
}

/// Largest distance from the reference frame's camera in a window, relative to its height.
double travel(const Recipe& recipe, int start, int frames) {
  const Eigen::Vector3d from = camera(recipe, start).p_wc;
  double farthest = 0;
  for (int i = 1; i < frames; ++i) {
    farthest = std::max(farthest, (camera(recipe, start + i).p_wc - from).norm());
  }
  return farthest / from.z();
}

const std::vector<std::string> kWellConditioned = {
    "sideways", "orbit", "approach", "diagonal", "up-down", "wander", "fast-arc"};

std::vector<std::string> all_nine() {
  std::vector<std::string> names = kWellConditioned;
  names.insert(names.end(), {"low-parallax", "rotation-dominant"});
  return names;
}

class Sequence : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Nine, Sequence, testing::ValuesIn(all_nine()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(Sequence, IsAPhonesRecordingOfThreeSeconds) {
  const Recipe recipe = sequence(GetParam());
  EXPECT_EQ(recipe.frame_count, 90);
  EXPECT_EQ(recipe.frame_rate, 30);
  EXPECT_EQ(recipe.camera.width, 640);
  EXPECT_EQ(recipe.camera.height, 480);
  EXPECT_EQ(recipe.camera.distortion, Distortion::radial_tangential);
  EXPECT_GT(std::abs(recipe.camera.coefficients[0]), 0.01);
  EXPECT_GT(recipe.image.noise, 0);
  EXPECT_GT(recipe.image.blur, 0);
}

TEST_P(Sequence, GyroscopeIsAPhones) {
  const GyroscopeRecipe gyroscope = sequence(GetParam()).gyroscope;
  EXPECT_EQ(gyroscope.rate, 200);
  EXPECT_GE(gyroscope.noise_density, 0.0002);
  EXPECT_LE(gyroscope.noise_density, 0.0004);
  EXPECT_GT(gyroscope.bias.cwiseAbs().minCoeff(), 0.001);
  EXPECT_LT(gyroscope.bias.cwiseAbs().maxCoeff(), 0.01);
  ASSERT_TRUE(gyroscope.calibrated_bias);
  EXPECT_NEAR((*gyroscope.calibrated_bias - gyroscope.bias).norm(), 0.002, 0.0002);
}

TEST_P(Sequence, BoardIsWithinEveryFrame) {
  const Recipe recipe = sequence(GetParam());
  ASSERT_TRUE(recipe.desk.board);
  for (int frame = 0; frame < recipe.frame_count; ++frame) {
    for (const Eigen::Vector3d& corner : board_corners(*recipe.desk.board)) {
      const Eigen::Vector2d px = project(recipe.camera, to_camera(camera(recipe, frame), corner));
      EXPECT_TRUE((px.array() > 5).all() && px.x() < 635 && px.y() < 475) << frame;
    }
  }
}

TEST(Sequences, WellConditionedOnesHaveParallaxInEveryWindow) {
  for (const std::string& name : kWellConditioned) {
    const Recipe recipe = sequence(name);
    for (const int start : {0, 10, 20, 30}) {
      EXPECT_GT(travel(recipe, start, 10), 0.045) << name << start;
      EXPECT_GT(travel(recipe, start, 30), 0.12) << name << start;
      EXPECT_LT(travel(recipe, start, 60), 0.7) << name << start;
    }
  }
}

TEST(Sequences, LowParallaxStaysLow) {
  const Recipe recipe = sequence("low-parallax");
  for (const int start : {0, 10, 20, 30}) {
    EXPECT_NEAR(travel(recipe, start, 30), 0.04, 0.01) << start;
    EXPECT_LT(travel(recipe, start, 60), 0.06) << start;
  }
}

TEST(Sequences, RotationDominantTurnsInPlace) {
  const Recipe recipe = sequence("rotation-dominant");
  double turned = 0;
  for (int i = 0; i < recipe.frame_count; ++i) {
    EXPECT_LT((camera(recipe, i).p_wc - camera(recipe, 0).p_wc).norm(), 0.0015) << i;
    const Eigen::Matrix3d turn = camera(recipe, 0).R_wc.transpose() * camera(recipe, i).R_wc;
    turned = std::max(turned, Eigen::AngleAxisd(turn).angle());
  }
  EXPECT_GT(turned, radians(10));
  EXPECT_LT(turned, radians(20));
}

TEST(Sequences, OneHasARollingShutterOneHasBlurAndMostHaveClutter) {
  int rolling = 0;
  int blurred = 0;
  int cluttered = 0;
  for (const std::string& name : all_nine()) {
    const Recipe recipe = sequence(name);
    rolling += recipe.image.rolling_shutter > 0 ? 1 : 0;
    blurred += recipe.image.exposure > 0.01 ? 1 : 0;
    cluttered += recipe.desk.boxes.empty() ? 0 : 1;
  }
  EXPECT_EQ(rolling, 1);
  EXPECT_EQ(blurred, 1);
  EXPECT_EQ(cluttered, 7);
}

TEST(Sequences, NoTwoShareSeedsOrDesks) {
  std::set<std::uint64_t> seeds;
  std::set<std::uint64_t> textures;
  for (const std::string& name : all_nine()) {
    seeds.insert(sequence(name).seed);
    textures.insert(sequence(name).desk.texture_seed);
  }
  EXPECT_EQ(seeds.size(), 9U);
  EXPECT_EQ(textures.size(), 9U);
}

}  // namespace
}  // namespace gpo
