// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/cube.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

const Plane kTilted{Vector3d(0.2, -0.5, -0.8).normalized(), 1};

void expect_stands_on(const CubeAnchor& anchor, const Plane& plane) {
  const double side = 0.3;
  const auto corners = cube_corners(anchor, side);
  for (int k = 0; k < 8; ++k) {
    const double height = plane.normal.dot(corners[k]) + plane.distance;
    EXPECT_NEAR(height, k < 4 ? 0 : side, 1e-12) << "corner " << k;  // towards the camera
  }
  EXPECT_NEAR((corners[1] - corners[0]).norm(), side, 1e-12);
  EXPECT_NEAR((corners[2] - corners[0]).norm(), side, 1e-12);
  EXPECT_NEAR((corners[1] - corners[0]).dot(corners[2] - corners[0]), 0, 1e-12);
}

TEST(Cube, StandsCenteredWhereTheRayMeetsThePlane) {
  const Vector3d ray(0.1, 0.2, 1);
  const auto anchor = anchor_on_plane(kTilted, Pose{}, ray);
  ASSERT_TRUE(anchor);
  expect_stands_on(*anchor, kTilted);
  const auto corners = cube_corners(*anchor, 0.3);
  const Vector3d center = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  EXPECT_LT(center.cross(ray).norm(), 1e-12);
  EXPECT_EQ(anchor->unit, 1);
  EXPECT_DOUBLE_EQ(default_cube_side(*anchor), 0.2);
}

TEST(Cube, StandsOnTheBoardsFirstCornerAlongItsRows) {
  const Board board{9, 6, 0.025};
  const Vector3d x = Vector3d(1, 0.3, 0).cross(kTilted.normal).normalized();
  const Vector3d y = x.cross(kTilted.normal);
  const Vector3d origin = *intersect(kTilted, Pose{}, Vector3d(-0.1, -0.1, 1));
  std::vector<Vector3d> rays;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 9; ++column)
      rays.emplace_back(origin + 0.04 * (column * x + row * y));
  }
  const auto anchor = anchor_on_board(kTilted, Pose{}, rays, board);
  ASSERT_TRUE(anchor);
  expect_stands_on(*anchor, kTilted);
  EXPECT_NEAR(anchor->unit, 0.04, 1e-12);
  EXPECT_LT((anchor->axes.col(0) - x).norm(), 1e-12);
  EXPECT_LT((anchor->axes.col(1) - y).norm(), 1e-12);
  EXPECT_NEAR(default_cube_side(*anchor), 0.2, 1e-12);  // five squares
}

TEST(Cube, HasNoPlaceWhereTheRayMissesThePlane) {
  EXPECT_FALSE(anchor_on_plane(kTilted, Pose{}, Vector3d(0, 0, -1)));
}

}  // namespace
}  // namespace gpo
