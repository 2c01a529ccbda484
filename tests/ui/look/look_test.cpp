// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/vtk_window.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/palette.h"
#include "ui/look/zoom.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
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

const Camera kZoomedCamera{640, 480, 500, 510, 322, 236, Distortion::none, {}};
const ScreenRect kZoomedRect{{100, 50}, {1280, 480}};

TEST(ImageZoom, FitsAndCentersTheImage) {
  const ImageMapping mapping = map_image(kZoomedCamera, kZoomedRect, {});
  EXPECT_DOUBLE_EQ(mapping.scale, 1);
  EXPECT_EQ(mapping.origin, Vector2d(100 + 320, 50));
}

TEST(ImageZoom, PutsPixelCentersHalfAPixelFromTheCorner) {
  const ImageMapping mapping{{10, 20}, 4};
  EXPECT_EQ(to_screen(mapping, {0, 0}), Vector2d(12, 22));
  EXPECT_EQ(to_screen(mapping, {-0.5, -0.5}), Vector2d(10, 20));
  EXPECT_LT((to_image(mapping, to_screen(mapping, {3.25, 7.5})) - Vector2d(3.25, 7.5)).norm(),
            1e-12);
}

TEST(ImageZoom, KeepsThePointUnderThePointer) {
  ImageZoom zoom;
  const Vector2d pointer(700, 300);
  const Vector2d before = to_image(map_image(kZoomedCamera, kZoomedRect, zoom), pointer);
  for (int i = 0; i < 5; ++i) zoom = zoom_about(zoom, kZoomedCamera, kZoomedRect, pointer, 1.3);
  const ImageMapping mapping = map_image(kZoomedCamera, kZoomedRect, zoom);
  // The image's corner is rounded to a whole screen pixel.
  EXPECT_LT((to_image(mapping, pointer) - before).norm(), 1 / mapping.scale);
  EXPECT_NEAR(zoom.factor, std::pow(1.3, 5), 1e-9);
  EXPECT_EQ(zoom_about(zoom, kZoomedCamera, kZoomedRect, pointer, 1e-9).factor, 1);
}

TEST(ImageZoom, PanFollowsThePointer) {
  const ImageZoom zoom{4, {0.5, 0.5}};
  const auto center_on_screen = [](const ImageZoom& shown) {
    return to_screen(map_image(kZoomedCamera, kZoomedRect, shown), {320, 240});
  };
  const ImageZoom moved = pan(zoom, kZoomedCamera, kZoomedRect, {30, -12});
  EXPECT_EQ(center_on_screen(moved) - center_on_screen(zoom), Vector2d(30, -12));
}

TEST(ImageMapping, UndistortsAsOpenCvDoes) {
  Camera camera = kZoomedCamera;
  camera.fx = camera.fy = 400;
  camera.cx = 330;
  camera.cy = 250;
  camera.distortion = Distortion::radial_tangential;
  camera.coefficients = {-0.28, 0.07, 0.0005, -0.0008};
  const ImageMapping mapping{{10, 20}, 2, &camera};
  const cv::Mat K = (cv::Mat_<double>(3, 3) << 400, 0, 330, 0, 400, 250, 0, 0, 1);
  for (const Vector2d& raw_px : {Vector2d(12, 30), Vector2d(330, 250), Vector2d(600, 460)}) {
    std::vector<cv::Point2d> pinhole_px;
    cv::undistortPoints(
        std::vector{cv::Point2d(raw_px.x(), raw_px.y())},
        pinhole_px,
        K,
        camera.coefficients,
        {},
        K,
        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12));
    const Vector2d on_screen(10 + 2 * (pinhole_px[0].x + 0.5), 20 + 2 * (pinhole_px[0].y + 0.5));
    EXPECT_LT((to_screen(mapping, raw_px) - on_screen).norm(), 1e-6);
    EXPECT_LT((to_image(mapping, on_screen) - raw_px).norm(), 1e-6);
  }
}

const ScreenRect kDiscRect{{100, 50}, {400, 300}};

TEST(NormalsZoom, MappingFitsTheDiscAndIsInvertible) {
  const DiscMapping all = map_disc(kDiscRect, {});
  EXPECT_EQ(all.to_screen({0, 0}), Vector2d(300, 200));
  EXPECT_LT(all.radius, 150) << "rim and labels fit";
  const DiscMapping zoomed = map_disc(kDiscRect, {20, {0.3, -0.2}});
  EXPECT_LT((zoomed.to_screen({0.3, -0.2}) - Vector2d(300, 200)).norm(), 1e-9);
  EXPECT_LT((zoomed.to_disc(zoomed.to_screen({0.31, -0.25})) - Vector2d(0.31, -0.25)).norm(),
            1e-12);
}

TEST(NormalsZoom, KeepsThePointUnderThePointer) {
  const Vector2d pointer(340, 170);
  const Vector2d before = map_disc(kDiscRect, {}).to_disc(pointer);
  const NormalsZoom zoom = zoom_about({}, kDiscRect, pointer, 8);
  EXPECT_DOUBLE_EQ(zoom.factor, 8);
  EXPECT_LT((map_disc(kDiscRect, zoom).to_disc(pointer) - before).norm(), 1e-9);
  const NormalsZoom all = zoom_about(zoom, kDiscRect, pointer, 1e-9);
  EXPECT_EQ(all.factor, 1);
  EXPECT_EQ(all.center, Vector2d(0, 0));
  EXPECT_EQ(zoom_about(zoom, kDiscRect, pointer, 1e9).factor, kLargestNormalsZoom);
}

TEST(NormalsZoom, PanMovesByScreenPixelsAndKeepsTheDiscInView) {
  const NormalsZoom zoom{10, {0.1, 0.1}};
  const auto on_screen = [](const NormalsZoom& shown) {
    return map_disc(kDiscRect, shown).to_screen({0.12, 0.1});
  };
  const NormalsZoom moved = pan(zoom, kDiscRect, {15, -7});
  EXPECT_LT((on_screen(moved) - on_screen(zoom) - Vector2d(15, -7)).norm(), 1e-9);
  EXPECT_LE(pan(zoom, kDiscRect, {1e6, 0}).center.norm(), 1 + 1e-12);
}

/// Returns the relative luminance (WCAG 2).
double luminance(std::uint32_t rgb) {
  const auto linear = [](double c) {
    return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(red(rgb)) + 0.7152 * linear(green(rgb)) + 0.0722 * linear(blue(rgb));
}

double contrast(std::uint32_t a, std::uint32_t b) {
  const double x = luminance(a), y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

TEST(Palette, TextHasEnoughContrast) {
  for (const Theme theme : {Theme::dark, Theme::light})
    for (const Role ground : {Role::background, Role::panel, Role::raised})
      for (const Role text :
           {Role::text, Role::text_dim, Role::accent, Role::good, Role::bad, Role::warning})
        EXPECT_GE(contrast(color_of(text, theme), color_of(ground, theme)), 4.5)
            << static_cast<int>(theme) << " " << static_cast<int>(text) << " on "
            << static_cast<int>(ground);
}

TEST(Palette, OnlyDataKeepTheirColorInBothThemes) {
  for (const Role role : {Role::inlier, Role::outlier, Role::residual, Role::cube_base})
    EXPECT_EQ(color_of(role, Theme::dark), color_of(role, Theme::light));
  for (const Role role : {Role::text, Role::panel, Role::selected, Role::truth})
    EXPECT_NE(color_of(role, Theme::dark), color_of(role, Theme::light));
}

TEST(Palette, PacksRedIntoTheLowestByteForDearImGui) {
  EXPECT_EQ(imgui_color(0x112233, 1), 0xFF332211U);
  EXPECT_EQ(imgui_color(0x112233, 0), 0x00332211U);
  EXPECT_EQ(mixed_rgb(0x000000, 0xFF0080, 0.5), 0x800040U);
}

}  // namespace
}  // namespace gpo
