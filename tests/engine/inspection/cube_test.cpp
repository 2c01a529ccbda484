// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/inspection/inspector.h"
#include "tests/engine/desk.h"

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

TEST(Cube, IsCenteredWhereTheRayMeetsThePlaneIfItDoes) {
  const Vector3d ray(0.1, 0.2, 1);
  const auto anchor = anchor_on_plane(kTilted, Pose{}, ray);
  ASSERT_TRUE(anchor);
  expect_stands_on(*anchor, kTilted);
  const auto corners = cube_corners(*anchor, 0.3);
  const Vector3d center = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  EXPECT_LT(center.cross(ray).norm(), 1e-12);
  EXPECT_EQ(anchor->unit, 1);
  EXPECT_DOUBLE_EQ(default_cube_side(*anchor), 0.2);
  EXPECT_FALSE(anchor_on_plane(kTilted, Pose{}, Vector3d(0, 0, -1)));
}

TEST(Cube, IsAtTheBoardsFirstCornerAlongItsRows) {
  const Board board{9, 6, 0.025};
  const Vector3d x = Vector3d(1, 0.3, 0).cross(kTilted.normal).normalized();
  const Vector3d y = x.cross(kTilted.normal);
  const Vector3d origin = *intersect(kTilted, Pose{}, Vector3d(-0.1, -0.1, 1));
  std::vector<Vector3d> rays;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 9; ++column)
      rays.emplace_back(origin + 0.04 * (column * x + row * y));
  const auto anchor = anchor_on_board(kTilted, Pose{}, rays, board);
  ASSERT_TRUE(anchor);
  expect_stands_on(*anchor, kTilted);
  EXPECT_NEAR(anchor->unit, 0.04, 1e-12);
  EXPECT_LT((anchor->axes.col(0) - x).norm(), 1e-12);
  EXPECT_LT((anchor->axes.col(1) - y).norm(), 1e-12);
  EXPECT_NEAR(default_cube_side(*anchor), 0.2, 1e-12);  // five squares
}

/// Returns the largest image distance between corners of both cubes in some frames.
double apart_px(const Inspection& inspection,
                const Camera& camera,
                const std::vector<int>& frames) {
  const CubeAnchor &cube = *inspection.cube, &true_cube = *inspection.true_cube;
  const double side = default_cube_side(cube, inspection.initialization->plane.distance);
  const auto corners = cube_corners(cube, side);
  const auto true_corners = cube_corners(true_cube, side * true_cube.unit / cube.unit);
  double most = 0;
  for (const int i : frames)
    for (int k = 0; k < 8; ++k) {
      const Vector3d a = to_camera(inspection.initialization->cameras[i], corners[k]);
      const Vector3d b = to_camera(*inspection.truth->cameras[i], true_corners[k]);
      most = std::max(most, (project(camera, a) - project(camera, b)).norm());
    }
  return most;
}

TEST(Cube, StandsOnItsOwnPlaneIfTheBoardIsOnAnother) {
  Inspector inspector(test::desk());
  const auto first = inspector.inspect({});
  const auto second = inspector.inspect({.options = {.plane = 2}});
  ASSERT_TRUE(first->cube && second->cube);
  EXPECT_TRUE(first->cube->on_board);
  EXPECT_FALSE(second->cube->on_board);
  const auto& tracks = second->window->planes.at(1).tracks;
  Eigen::AlignedBox2d seen;
  for (const int j : tracks) seen.extend(second->window->points_px[0].col(j));
  const Eigen::Vector2d at_px = (second->window->K * second->cube->origin).hnormalized();
  EXPECT_TRUE(seen.contains(at_px)) << at_px.transpose();
}

TEST(Cube, MovesToTheSamePlaceInTruth) {
  // The most accurate method here.
  const Settings settings{.start = 20, .frames = 30, .options = {.method = "ba"}};
  Inspection inspection = *Inspector(test::desk()).inspect(settings);
  ASSERT_TRUE(inspection.cube && inspection.true_cube);
  const Camera& camera = inspection.recording->camera;
  EXPECT_LT(apart_px(inspection, camera, {0}), 1);
  // At a tenth, the middle and nine tenths of the image.
  for (const Vector3d& ray :
       {Vector3d(-0.4, -0.1, 1), Vector3d(0, 0.1, 1), Vector3d(0.4, 0.3, 1)}) {
    move_cubes(inspection, ray);
    EXPECT_LT(apart_px(inspection, camera, {0, 15, 29}), 2) << ray.transpose();
  }
}

/// A correct estimate in another unit and another world than those of the truth, whose origin is on
/// the plane.
struct MovedCube : ::testing::Test {
  void place(bool on_board) {
    Initialization estimate;
    estimate.ok = true;
    estimate.plane = facing_origin({Vector3d(0.1, -0.5, -1).normalized(), 1});
    estimate.cameras = {Pose{},
                        {so3_exp({0.1, -0.2, 0.05}), {0.2, -0.1, 0.3}},
                        {so3_exp({-0.2, 0.3, 0.4}), {-0.5, 0.2, 0.1}}};
    const Pose reference{so3_exp({2.1, 0.4, -0.3}), Vector3d::Zero()};
    const Plane in_meters{estimate.plane.normal, kMetersAUnit * estimate.plane.distance};
    const Vector3d foot = -in_meters.distance * (reference.R_wc * in_meters.normal);
    WindowTruth truth;
    truth.plane = Plane{reference.R_wc * in_meters.normal, 0};
    for (const Pose& camera : estimate.cameras)
      truth.cameras.push_back(
          Pose{reference.R_wc * camera.R_wc, kMetersAUnit * (reference.R_wc * camera.p_wc) - foot});
    const auto anchor = [&](const Plane& plane, const Pose& camera) {
      const Board board{.columns = 2, .rows = 2, .square_m = 0.03};
      const Vector3d rays[] = {{0, 0, 1}, {0.08, 0.01, 1}, {0, 0.08, 1}, {0.08, 0.08, 1}};
      return on_board ? anchor_on_board(plane, camera, rays, board)
                      : anchor_on_plane(plane, camera, rays[0]);
    };
    inspection_.cube = anchor(estimate.plane, Pose{});
    inspection_.true_cube = anchor(*truth.plane, *truth.cameras.front());
    inspection_.initialization = std::make_shared<const Initialization>(std::move(estimate));
    inspection_.truth = std::make_shared<const WindowTruth>(std::move(truth));
  }

  static constexpr double kMetersAUnit = 0.4;
  const Camera camera_{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  Inspection inspection_;
};

TEST_F(MovedCube, CentersTheBaseOnTheRayAndTheTrueCubeAtTheSamePlace) {
  for (const bool on_board : {false, true}) {
    place(on_board);
    ASSERT_TRUE(inspection_.cube && inspection_.true_cube);
    EXPECT_LT(apart_px(inspection_, camera_, {0, 1, 2}), 1e-9)
        << "at the automatic place, on_board = " << on_board;
    for (const Vector3d& ray :
         {Vector3d(0.1, 0.2, 1), Vector3d(-0.4, 0.3, 1), Vector3d(-0.2, 0.1, 1)}) {
      move_cubes(inspection_, ray);
      const double side =
          default_cube_side(*inspection_.cube, inspection_.initialization->plane.distance);
      const auto corners = cube_corners(*inspection_.cube, side);
      EXPECT_LT(angle_deg((corners[0] + corners[3]) / 2, ray), 1e-6);
      EXPECT_LT(apart_px(inspection_, camera_, {0, 1, 2}), 1e-9)
          << "moved, on_board = " << on_board;
    }
  }
}

TEST_F(MovedCube, StaysIfTheRayMissesAndDropsAMissedTrueCube) {
  place(false);
  const Vector3d before = inspection_.cube->origin;
  move_cubes(inspection_, -Vector3d::UnitZ());
  EXPECT_EQ(inspection_.cube->origin, before);
  EXPECT_TRUE(inspection_.true_cube.has_value());
  WindowTruth behind = *inspection_.truth;
  Plane& plane = *behind.plane;
  plane.distance -= 2 * (plane.normal.dot(behind.cameras.front()->p_wc) + plane.distance);
  inspection_.truth = std::make_shared<const WindowTruth>(behind);
  move_cubes(inspection_, {0.1, 0.2, 1});
  EXPECT_NE(inspection_.cube->origin, before);
  EXPECT_FALSE(inspection_.true_cube.has_value());
}

}  // namespace
}  // namespace gpo
