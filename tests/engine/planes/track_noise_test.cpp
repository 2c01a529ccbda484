// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/planes/inliers.h"
#include "tests/engine/simulated_window.h"

#include <random>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

Simulation noisy_window(Motion motion, double noise_px) {
  return simulate(
      {.motion = motion, .noise_px = noise_px, .off_plane = 0.3, .reference_noise_px = noise_px});
}

Camera camera_of_size(int width, int height) { return {.width = width, .height = height}; }

TEST(PixelUnit, IsOneForUsualImagesAndFollowsTheDiagonalOfOthers) {
  EXPECT_EQ(pixel_unit(camera_of_size(512, 512)), 1);
  EXPECT_EQ(pixel_unit(camera_of_size(1280, 960)), 1);
  EXPECT_DOUBLE_EQ(pixel_unit(camera_of_size(320, 240)), 400.0 / 720);
  EXPECT_DOUBLE_EQ(pixel_unit(camera_of_size(2400, 3200)), 2.5);
  const Eigen::Matrix3d K{{3000, 0, 1599.5}, {0, 3000, 1199.5}, {0, 0, 1}};
  EXPECT_DOUBLE_EQ(pixel_unit(K), 2.5);
}

TEST(TrackNoise, IsEstimatedOnAnySurfaceAndMotion) {
  for (const Motion motion : kMotions)
    for (const double noise_px : {0.1, 0.5, 2.0})
      EXPECT_NEAR(track_noise_px(noisy_window(motion, noise_px).window.points_px),
                  noise_px,
                  0.1 * noise_px);
}

TEST(TrackNoise, HardlyGrowsByGrossErrors) {
  std::vector<Eigen::Matrix2Xd> points_px = noisy_window(Motion::orbit, 0.5).window.points_px;
  std::mt19937_64 random(1);
  for (Eigen::Matrix2Xd& points : points_px)
    for (int k = 0; k < 8; ++k)
      points.col(static_cast<int>(random() % points.cols())).array() += 50;
  EXPECT_NEAR(track_noise_px(points_px), 0.6, 0.15);
}

TEST(TrackNoise, IsZeroWithoutEnoughFramesOrTracks) {
  std::vector<Eigen::Matrix2Xd> points_px = noisy_window(Motion::orbit, 0.5).window.points_px;
  points_px.resize(3);
  EXPECT_EQ(track_noise_px(points_px), 0);
  points_px.assign(10, Eigen::Matrix2Xd::Random(2, 7));
  EXPECT_EQ(track_noise_px(points_px), 0);
}

TEST(UsualThreshold, FollowsTheImageAndTheNoise) {
  const auto threshold_px = [](int width, double noise_px) {
    return usual_threshold_px(camera_of_size(width, width * 3 / 4),
                              noisy_window(Motion::orbit, noise_px).window.points_px);
  };
  EXPECT_EQ(threshold_px(640, 0.1), 2);
  EXPECT_EQ(threshold_px(2560, 0.1), 4);
  EXPECT_NEAR(threshold_px(640, 1), 4.2, 0.4);
  EXPECT_EQ(threshold_px(640, 5), 8);
}

}  // namespace
}  // namespace gpo::test
