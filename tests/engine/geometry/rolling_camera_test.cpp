// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/rolling_camera.h"

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

Camera lens() {
  Camera camera{640, 480, 500, 505, 322.3, 236.8, Distortion::radial_tangential};
  camera.coefficients = {-0.2, 0.05, 0.001, -0.0005};
  return camera;
}

RollingCamera brisk(const Camera& camera) {
  RollingCamera rolling{camera};
  rolling.row_delay_s = 5e-5;
  rolling.motion = {.rotation_rad_s = {0.4, -1.1, 0.7},
                    .rotation_rad_s2 = {8, 5, -9},
                    .translation_s = {0.5, -0.2, 0.3},
                    .translation_s2 = {3, -4, 2}};
  return rolling;
}

TEST(RollingCamera, ProjectsToThePixelWhoseRowIsReadThere) {
  for (const auto direction : {ReadoutDirection::down,
                               ReadoutDirection::left,
                               ReadoutDirection::up,
                               ReadoutDirection::right}) {
    Camera camera = lens();
    camera.readout_direction = direction;
    const RollingCamera rolling = brisk(camera);
    for (const Vector3d& point : {Vector3d(0.3, 0.25, 1), Vector3d(-0.5, -0.3, 1.2)}) {
      const Vector2d px = project(rolling, point);
      const double seconds = rolling.row_delay_s * row_from_middle(camera, px);
      const Pose pose{so3_exp(seconds * rolling.motion.rotation_rad_s +
                              0.5 * seconds * seconds * rolling.motion.rotation_rad_s2),
                      seconds * rolling.motion.translation_s +
                          0.5 * seconds * seconds * rolling.motion.translation_s2};
      EXPECT_LT((project(camera, to_camera(pose, point)) - px).norm(), 1e-3);
      EXPECT_GT((project(camera, point) - px).norm(), 1);
    }
  }
}

TEST(RollingCamera, FindsThePointThatItProjects) {
  const Camera camera = lens();
  const RollingCamera rolling = brisk(camera);
  const Plane plane{Vector3d(0.1, -0.4, -0.9).normalized(), 1.3};
  const Pose pose{so3_exp({0.1, 0.2, -0.1}), {0.1, 0, 0.05}};
  for (const Vector2d& px : {Vector2d(40, 450), Vector2d(600, 30)}) {
    const auto point = intersect(plane, pose, rolling, px);
    ASSERT_TRUE(point);
    EXPECT_NEAR(plane.normal.dot(*point) + plane.distance, 0, 1e-12);
    EXPECT_LT((project(rolling, to_camera(pose, *point)) - px).norm(), 1e-2);
    const auto moved = at_time_stamp({px}, plane, pose, rolling);
    EXPECT_LT((moved.front() - project(camera, to_camera(pose, *point))).norm(), 1e-9);
  }
}

TEST(RollingCamera, IsAnOrdinaryCameraWithAGlobalShutter) {
  const Camera camera = lens();
  RollingCamera still = brisk(camera);
  still.row_delay_s = 0;
  const Vector3d point(0.3, 0.25, 1);
  EXPECT_EQ(project(still, point), project(camera, point));
  EXPECT_FALSE(project(still, Vector3d(0, 0, -1)).allFinite() &&
               !project(camera, Vector3d(0, 0, -1)).allFinite());
}

}  // namespace
}  // namespace gpo::test
