// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/orbit_camera.h"

#include "ui/context/vtk_window.h"

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

/// Returns the pixel at which VTK draws a point; y down, corner at (0, 0).
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

constexpr double kViewHeight = 600;
const Vector2d kViewSize(800, kViewHeight);

TEST(VtkCamera, SeesTheSameAsTheOrbitCamera) {
  vtkNew<vtkCamera> vtk;
  set_camera_from_orbit(*vtk, made_camera());
  for (const Vector3d& point : made_points(50, 1)) {
    const auto pixel = view_pixel(made_camera(), point, kViewSize);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - vtk_pixel(*vtk, point, 800, kViewHeight)).norm(), 1e-6);
  }
}

TEST(OrbitCamera, AxesAreARotationAndTheTargetIsInTheMiddle) {
  const OrbitCamera camera = made_camera();
  const Eigen::Matrix3d axes = view_axes(camera);
  EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(axes.determinant(), 1, 1e-12);
  EXPECT_LT((*view_pixel(camera, camera.target, kViewSize) - kViewSize / 2).norm(), 1e-9);
  const Vector2d above = *view_pixel(camera, camera.target + 0.1 * camera.up, kViewSize);
  EXPECT_NEAR(above.x(), 400, 1e-9);
  EXPECT_LT(above.y(), 300) << "up is up";
  EXPECT_GT(camera.up.dot(eye(camera) - camera.target), 0);
}

TEST(OrbitCamera, MouseMovesTheSceneWithThePointer) {
  const OrbitCamera camera = made_camera();
  // The scene's nearest part moves right and down with a drag to the right and down.
  const Vector3d near = camera.target - 0.3 * view_axes(camera).col(2);
  const Vector2d moved = *view_pixel(orbited(camera, {20, 20}, kViewHeight), near, kViewSize);
  EXPECT_GT(moved.x(), 400);
  EXPECT_GT(moved.y(), 300);
  EXPECT_LE(orbited(camera, {0, 5000}, kViewHeight).pitch_deg, 89);
  EXPECT_GE(orbited(camera, {0, -5000}, kViewHeight).pitch_deg, -89);
  const OrbitCamera pan = panned(camera, {31, -17}, kViewHeight);
  EXPECT_LT((*view_pixel(pan, camera.target, kViewSize) - Vector2d(431, 283)).norm(), 1e-9);
  EXPECT_LT(zoomed(camera, 1).distance, camera.distance);
  EXPECT_NEAR(zoomed(zoomed(camera, 3), -3).distance, camera.distance, 1e-12);
}

TEST(OrbitCamera, FitShowsAllPointsWithinTheMarginsAndIsTight) {
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
    // Touches both margins along the tighter axis.
    const Vector2d before(least.x() + 0.7, least.y() + 0.95), after(0.9 - most.x(), 0.6 - most.y());
    EXPECT_GT(before.cwiseMin(after).minCoeff(), -1e-9);
    EXPECT_LT(before.cwiseMax(after).minCoeff(), 1e-9);
    EXPECT_EQ(camera.yaw_deg, made_camera().yaw_deg);
  }
  EXPECT_EQ(fitted(made_camera(), {}, 1).distance, made_camera().distance);
}

}  // namespace
}  // namespace gpo
