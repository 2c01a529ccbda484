// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera_resection.h"

#include <vector>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

const std::vector<Pose> kCameras{
    {}, {so3_exp({0, 0.1, 0}), {0.3, 0, 0}}, {so3_exp({0.1, 0, 0.2}), {0, 0.2, 0.1}}};

Eigen::Matrix3Xd rays_to(const Vector3d& point) {
  Eigen::Matrix3Xd rays(3, kCameras.size());
  for (std::size_t i = 0; i < kCameras.size(); ++i) {
    const Vector3d y = to_camera(kCameras[i], point);
    rays.col(static_cast<int>(i)) = y / y.z();
  }
  return rays;
}

TEST(Triangulation, IsExactWithoutNoise) {
  for (const Vector3d& point :
       {Vector3d(0, 0, 1), Vector3d(-1, 0.5, 3), Vector3d(0.2, -0.4, 0.9)}) {
    const auto found = triangulate(kCameras, rays_to(point));
    ASSERT_TRUE(found);
    EXPECT_LT((*found - point).norm(), 1e-10);
  }
}

TEST(Triangulation, IsAStationaryPointOfTheReprojectionError) {
  Eigen::Matrix3Xd rays = rays_to({0.1, 0.2, 1.5});
  rays.topRows<2>() += 0.002 * Eigen::Matrix2Xd::Ones(2, 3).cwiseProduct(
                                   (Eigen::Matrix2Xd(2, 3) << 1, -1, 1, -1, -1, 1).finished());
  const Vector3d found = triangulate(kCameras, rays).value();
  const auto cost = [&](const Vector3d& point) {
    double sum = 0;
    for (std::size_t i = 0; i < kCameras.size(); ++i) {
      const Vector3d y = to_camera(kCameras[i], point);
      sum += (y / y.z() - rays.col(static_cast<int>(i))).squaredNorm();
    }
    return sum;
  };
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(cost(found + 1e-3 * Vector3d::Unit(k)), cost(found));
    EXPECT_GT(cost(found - 1e-3 * Vector3d::Unit(k)), cost(found));
  }
}

TEST(Triangulation, RefusesParallelRaysAndPointsBehind) {
  const std::vector<Pose> same{{}, {}};
  EXPECT_FALSE(triangulate(same, Eigen::Matrix3Xd::Ones(3, 2)));
  Eigen::Matrix3Xd diverging(3, 2);
  diverging << -0.2, 0.2, 0, 0, 1, 1;
  const std::vector<Pose> apart{{}, {Eigen::Matrix3d::Identity(), {0.3, 0, 0}}};
  EXPECT_FALSE(triangulate(apart, diverging));
}

TEST(Triangulation, ParallaxIsTheAngleOfTheRays) {
  const std::vector<Pose> apart{{}, {Eigen::Matrix3d::Identity(), {1, 0, 0}}};
  EXPECT_NEAR(parallax_deg(apart, {0, 0, 1}), 45, 1e-12);
}

}  // namespace
}  // namespace gpo
