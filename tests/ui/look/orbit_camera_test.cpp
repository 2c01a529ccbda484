// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/orbit_camera.h"

#include "ui/views/scene/scene_actors.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Where VTK puts a point on a view of that size; y down, corner at (0, 0).
Vector2d vtk_pixel(vtkCamera& camera, const Vector3d& point, double width, double height) {
  const auto* m = camera.GetCompositeProjectionTransformMatrix(width / height, -1, 1);
  Eigen::Matrix4d M;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) M(row, column) = m->GetElement(row, column);
  const Eigen::Vector4d clip = M * point.homogeneous();
  return {(clip.x() / clip.w() + 1) / 2 * width, (1 - clip.y() / clip.w()) / 2 * height};
}

OrbitCamera made_camera() {
  OrbitCamera camera;
  camera.target = Vector3d(0.3, -0.2, 1);
  camera.up = Vector3d(0.1, -0.9, -0.4).normalized();
  camera.front = (Vector3d::UnitZ() - camera.up * camera.up.z()).normalized();
  camera.yaw_deg = 35;
  camera.pitch_deg = 25;
  camera.distance = 3;
  return camera;
}

std::vector<Vector3d> made_points(int count, double depth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> around(-1, 1);
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(around(random), around(random), depth + around(random));
  return points;
}

TEST(VtkCamera, SeesWhatTheOrbitCameraSees) {
  vtkNew<vtkCamera> vtk;
  set_camera_from_orbit(*vtk, made_camera());
  for (const Vector3d& point : made_points(50, 1)) {
    const auto pixel = view_pixel(made_camera(), point, {800, 600});
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - vtk_pixel(*vtk, point, 800, 600)).norm(), 1e-6);
  }
}

TEST(OrbitCamera, AxesAreARotationAndTheTargetIsInTheMiddle) {
  const Eigen::Matrix3d axes = view_axes(made_camera());
  EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(axes.determinant(), 1, 1e-12);
  EXPECT_LT(
      (*view_pixel(made_camera(), made_camera().target, {800, 600}) - Vector2d(400, 300)).norm(),
      1e-9);
}

TEST(OrbitCamera, UpIsUp) {
  const OrbitCamera camera = made_camera();
  const Vector2d above = *view_pixel(camera, camera.target + 0.1 * camera.up, {800, 600});
  EXPECT_NEAR(above.x(), 400, 1e-9);
  EXPECT_LT(above.y(), 300);
  EXPECT_GT(camera.up.dot(eye(camera) - camera.target), 0);
}

TEST(OrbitCamera, DragsTurnTheSceneWithThePointer) {
  const OrbitCamera camera = made_camera();
  // What is nearest to the eye moves right and down with a drag to the right and down.
  const Vector3d near = camera.target - 0.3 * view_axes(camera).col(2);
  const Vector2d moved = *view_pixel(orbited(camera, {20, 20}, 600), near, {800, 600});
  EXPECT_GT(moved.x(), 400);
  EXPECT_GT(moved.y(), 300);
  EXPECT_LE(orbited(camera, {0, 5000}, 600).pitch_deg, 89);
  EXPECT_GE(orbited(camera, {0, -5000}, 600).pitch_deg, -89);
}

TEST(OrbitCamera, PanCarriesTheTargetWithThePointer) {
  const OrbitCamera camera = made_camera();
  const Vector2d moved = *view_pixel(panned(camera, {31, -17}, 600), camera.target, {800, 600});
  EXPECT_LT((moved - Vector2d(431, 283)).norm(), 1e-9);
}

TEST(OrbitCamera, WheelComesNearerAndGoesBack) {
  const OrbitCamera camera = made_camera();
  EXPECT_LT(zoomed(camera, 1).distance, camera.distance);
  EXPECT_NEAR(zoomed(zoomed(camera, 3), -3).distance, camera.distance, 1e-12);
}

TEST(OrbitCamera, FitShowsEverythingWithinTheMarginsAndNoMoreThanNeeded) {
  const auto points = made_points(40, 2);
  const FitMargins margins{.left = 0.3, .right = 0.1, .top = 0.05, .bottom = 0.4};
  for (const double aspect : {0.5, 1.0, 2.0}) {
    const OrbitCamera camera = fitted(made_camera(), points, aspect, margins);
    const Vector2d half(300 * aspect, 300);
    Vector2d least(2, 2), most(-2, -2);
    for (const Vector3d& point : points) {
      const auto pixel = view_pixel(camera, point, 2 * half);
      ASSERT_TRUE(pixel);
      const Vector2d normalized = (*pixel - half).cwiseQuotient(half);
      least = least.cwiseMin(normalized);
      most = most.cwiseMax(normalized);
    }
    // Within the margins, and touching both of them along the tighter axis.
    const double gap_x = std::max(least.x() + 0.7, 0.9 - most.x());
    const double gap_y = std::max(least.y() + 0.95, 0.6 - most.y());
    EXPECT_GT(std::min(least.x() + 0.7, 0.9 - most.x()), -1e-9);
    EXPECT_GT(std::min(least.y() + 0.95, 0.6 - most.y()), -1e-9);
    EXPECT_LT(std::min(gap_x, gap_y), 1e-9);
    EXPECT_EQ(camera.yaw_deg, made_camera().yaw_deg);
  }
}

TEST(OrbitCamera, FitOfNothingChangesNothing) {
  EXPECT_EQ(fitted(made_camera(), {}, 1).distance, made_camera().distance);
}

}  // namespace
}  // namespace gpo
