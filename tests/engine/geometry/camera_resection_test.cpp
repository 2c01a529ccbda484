// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera_resection.h"

#include "tests/engine/rotation_error.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using test::rotation_error_deg;

struct Scene {
  Eigen::Matrix3d K = (Eigen::Matrix3d() << 480, 0, 310, 0, 500, 250, 0, 0, 1).finished();
  Pose pose;
  Eigen::Matrix3Xd points;
  Eigen::Matrix2Xd pixels;
};

/// 40 points near the plane z = 2, `thickness` deep.
Scene random_scene(std::uint64_t seed, double thickness, double noise_px) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> noise;
  Scene s;
  s.pose.R_wc = so3_exp(0.3 * Vector3d(uniform(random), uniform(random), uniform(random)));
  s.pose.p_wc = 0.3 * Vector3d(uniform(random), uniform(random), uniform(random));
  s.points.resize(3, 40);
  s.pixels.resize(2, 40);
  for (int k = 0; k < 40; ++k) {
    s.points.col(k) << uniform(random), uniform(random), 2 + thickness * uniform(random);
    s.pixels.col(k) = (s.K * to_camera(s.pose, s.points.col(k))).hnormalized();
    s.pixels.col(k) += noise_px * Eigen::Vector2d(noise(random), noise(random));
  }
  return s;
}

TEST(CameraResection, IsExactWithoutNoiseOnAPlaneAndOffIt) {
  for (const double thickness : {0.0, 0.01, 0.5}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Scene s = random_scene(seed, thickness, 0);
      const auto found = resect_camera(s.points, s.pixels, s.K);
      ASSERT_TRUE(found);
      EXPECT_LT((found->pose.p_wc - s.pose.p_wc).norm(), 1e-8);
      EXPECT_LT(rotation_error_deg(found->pose, s.pose), 1e-6);
      EXPECT_LT(found->median_px, 1e-6);
    }
  }
}

TEST(CameraResection, ABadPointInEightDoesNoHarm) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene s = random_scene(seed, 0.02, 0.3);
    for (int k = 0; k < 5; ++k) s.pixels.col(8 * k) += Eigen::Vector2d(30, -20 - k);
    const auto found = resect_camera(s.points, s.pixels, s.K);
    ASSERT_TRUE(found);
    EXPECT_LT((found->pose.p_wc - s.pose.p_wc).norm(), 0.01);
    EXPECT_LT(rotation_error_deg(found->pose, s.pose), 0.3);
  }
}

TEST(CameraResection, RefinesFromANeighborsPose) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene s = random_scene(seed, 0.02, 0);
    Pose neighbor = s.pose;
    neighbor.R_wc = neighbor.R_wc * so3_exp({0.02, -0.03, 0.01});
    neighbor.p_wc += Vector3d(0.05, 0, -0.03);
    const auto found = refine_pose(neighbor, s.points, s.pixels, s.K);
    ASSERT_TRUE(found);
    EXPECT_LT((found->pose.p_wc - s.pose.p_wc).norm(), 1e-8);
  }
}

TEST(CameraResection, RefusesTooFewPointsAndPointsBehind) {
  const Scene s = random_scene(1, 0, 0);
  EXPECT_FALSE(resect_camera(s.points.leftCols(3), s.pixels.leftCols(3), s.K));
  const Pose turned{so3_exp({0, 3.1, 0}), Vector3d::Zero()};
  EXPECT_FALSE(refine_pose(turned, s.points, s.pixels, s.K));
}

}  // namespace
}  // namespace gpo
