// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/context/vtk_window.h"
#include "ui/views/image/image_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <opencv2/core.hpp>
#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>

namespace gpo {
namespace {

using Eigen::Vector2d, Eigen::Vector3d, testing::AllOf, testing::ElementsAre, testing::HasSubstr;
using testing::IsEmpty, testing::Not, testing::Pair;
using enum Readiness;

const Vector2d kViewSize(800, 600);
const ScreenRect kView{{0, 0}, kViewSize};
const double kViewHeight = kViewSize.y();

/// Returns the pixel at which VTK draws a point; y down, corner at (0, 0).
Vector2d vtk_pixel(vtkCamera& camera, const Vector3d& point) {
  auto* matrix = camera.GetCompositeProjectionTransformMatrix(kViewSize.x() / kViewHeight, -1, 1);
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> M(matrix->GetData());
  const Vector3d clip = (M * point.homogeneous()).hnormalized();
  return kViewSize.cwiseProduct(Vector2d(1 + clip.x(), 1 - clip.y())) / 2;
}

OrbitCamera made_camera() {
  OrbitCamera camera{.target = {0.3, -0.2, 1}, .yaw_deg = 35, .pitch_deg = 25, .distance = 3};
  camera.up = Vector3d(0.1, -0.9, -0.4).normalized();
  camera.front = (Vector3d::UnitZ() - camera.up * camera.up.z()).normalized();
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

TEST(NumberText, HasNoNegativeZero) {
  EXPECT_EQ(number_text(-0.5, 0), "0");
  EXPECT_EQ(number_text(-0.51, 0), "-1");
  EXPECT_EQ(number_text(-0.0004, 3), "0.000");
}

TEST(VtkCamera, SeesTheSameAsTheOrbitCamera) {
  vtkNew<vtkCamera> vtk;
  set_camera_from_orbit(*vtk, made_camera());
  for (const Vector3d& point : made_points(50, 1)) {
    const Vector2d pixel = on_screen(made_camera(), point, kView).value();
    EXPECT_LT((pixel - vtk_pixel(*vtk, point)).norm(), 1e-6);
  }
}

TEST(OrbitCamera, AxesAreARotationAndTheTargetIsInTheMiddle) {
  const OrbitCamera camera = made_camera();
  const Eigen::Matrix3d axes = view_axes(camera);
  EXPECT_TRUE(axes.isUnitary(1e-12));
  EXPECT_NEAR(axes.determinant(), 1, 1e-12);
  EXPECT_LT((*on_screen(camera, camera.target, kView) - kViewSize / 2).norm(), 1e-9);
  const Vector2d above = *on_screen(camera, camera.target + 0.1 * camera.up, kView);
  EXPECT_NEAR(above.x(), 400, 1e-9);
  EXPECT_LT(above.y(), 300) << "up is up";
  EXPECT_GT(camera.up.dot(eye(camera) - camera.target), 0);
}

TEST(OrbitCamera, MouseMovesTheSceneWithThePointer) {
  const OrbitCamera camera = made_camera();
  // The scene's nearest part moves right and down with a drag to the right and down.
  const Vector3d near = camera.target - 0.3 * view_axes(camera).col(2);
  const Vector2d moved = *on_screen(orbited(camera, {20, 20}, kViewHeight), near, kView);
  EXPECT_GT(moved.x(), 400);
  EXPECT_GT(moved.y(), 300);
  EXPECT_LE(orbited(camera, {0, 5000}, kViewHeight).pitch_deg, 89);
  EXPECT_GE(orbited(camera, {0, -5000}, kViewHeight).pitch_deg, -89);
  const OrbitCamera pan = panned(camera, {31, -17}, kViewHeight);
  EXPECT_LT((*on_screen(pan, camera.target, kView) - Vector2d(431, 283)).norm(), 1e-9);
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
      const Vector2d pixel = on_screen(camera, point, {{0, 0}, 2 * half}).value();
      const Vector2d normalized = (pixel - half).cwiseQuotient(half);
      least = least.cwiseMin(normalized);
      most = most.cwiseMax(normalized);
    }
    // Touches both margins along the tighter axis.
    const Vector2d before(least.x() + 0.7, least.y() + 0.95), after(0.9 - most.x(), 0.6 - most.y());
    ASSERT_TRUE(before.allFinite() && after.allFinite());
    EXPECT_GT(before.cwiseMin(after).minCoeff(), -1e-9);
    EXPECT_LT(before.cwiseMax(after).minCoeff(), 1e-9);
    EXPECT_EQ(camera.yaw_deg, made_camera().yaw_deg);
  }
  EXPECT_EQ(fitted(made_camera(), {}, 1).distance, made_camera().distance);
}

const Camera kZoomedCamera{640, 480, 500, 510, 322, 236, Distortion::none, {}};
const ScreenRect kZoomedRect{{100, 50}, {1280, 480}};

TEST(ImageZoom, FitsAndCentersTheImageAndPutsPixelCentersHalfAPixelFromTheCorner) {
  const ImageMapping mapping = map_image(kZoomedCamera, kZoomedRect, {});
  EXPECT_DOUBLE_EQ(mapping.scale, 1);
  EXPECT_EQ(mapping.origin, Vector2d(100 + 320, 50));
  const ImageMapping to{.origin = {10, 20}, .scale = 4};
  EXPECT_EQ(to_screen(to, {0, 0}), Vector2d(12, 22));
  EXPECT_EQ(to_screen(to, {-0.5, -0.5}), Vector2d(10, 20));
  EXPECT_LT((to_image(to, to_screen(to, {3.25, 7.5})) - Vector2d(3.25, 7.5)).norm(), 1e-12);
}

TEST(ImageZoom, TurnsPixelsLikeOpenCv) {
  const Camera camera{.width = 7, .height = 5};
  cv::Mat numbers(5, 7, CV_32S);
  for (int i = 0; i < 35; ++i) numbers.at<int>(i / 7, i % 7) = i;
  for (const auto& [turns, code] : {std::pair{1, cv::ROTATE_90_CLOCKWISE},
                                    {2, cv::ROTATE_180},
                                    {3, cv::ROTATE_90_COUNTERCLOCKWISE}}) {
    cv::Mat turned;
    cv::rotate(numbers, turned, code);
    const ShownImage image(camera, turns);
    EXPECT_EQ(image.size(), Vector2d(turned.cols, turned.rows));
    const ImageMapping mapping = map_image(image, {{20, 30}, 10 * image.size()}, {});
    EXPECT_EQ(mapping.end(), Vector2d(20, 30) + 10 * image.size());
    for (int i = 0; i < 35; ++i) {
      const Vector2d raw_px(i % 7, i / 7), screen = to_screen(mapping, raw_px);
      const Vector2d shown = (screen - Vector2d(20, 30)) / 10;
      EXPECT_EQ(turned.at<int>(static_cast<int>(shown.y()), static_cast<int>(shown.x())), i);
      EXPECT_EQ(to_image(mapping, screen), raw_px);
    }
  }
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

const ScreenRect kDiscRect{{100, 50}, {400, 300}};

TEST(NormalsZoom, MappingFitsTheDiscAndIsInvertible) {
  const DiscMapping all = map_disc(kDiscRect, {});
  EXPECT_EQ(all.to_screen({0, 0}), Vector2d(300, 200));
  EXPECT_LT(all.radius, 150) << "rim and labels fit";
  const DiscMapping to = map_disc(kDiscRect, {20, {0.3, -0.2}});
  EXPECT_LT((to.to_screen({0.3, -0.2}) - Vector2d(300, 200)).norm(), 1e-9);
  EXPECT_LT((to.to_disc(to.to_screen({0.31, -0.25})) - Vector2d(0.31, -0.25)).norm(), 1e-12);
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
  Eigen::Array3d c(red(rgb), green(rgb), blue(rgb));
  c = (c <= 0.03928).select(c / 12.92, ((c + 0.055) / 1.055).pow(2.4));
  return c.matrix().dot(Vector3d(0.2126, 0.7152, 0.0722));
}

double contrast(std::uint32_t a, std::uint32_t b) {
  const auto [darker, lighter] = std::minmax({luminance(a), luminance(b)});
  return (lighter + 0.05) / (darker + 0.05);
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

TEST(PixelText, ShowsPlaceValueAndZoom) {
  const Camera camera{.width = 4, .height = 3, .fx = 1, .fy = 1};
  cv::Mat bgr(3, 4, CV_8UC3, cv::Scalar(10, 20, 30));
  bgr.at<cv::Vec3b>(2, 3) = {7, 7, 7};
  const auto text_at = [&](const Vector2d& raw_px, const cv::Mat& pixels, double scale = 1) {
    return pixel_text({nullptr, 0, camera, pixels, raw_px, scale});
  };
  EXPECT_EQ(text_at({0.25, 1.75}, bgr, 2.5), "x 0.2  y 1.8 px   RGB 30 20 10   250 %");
  EXPECT_EQ(text_at({2.6, 2.4}, bgr), "x 2.6  y 2.4 px   gray 7   100 %")
      << "a pixel's center has whole coordinates";
  EXPECT_EQ(text_at({-0.5, 0}, {}), "x -0.5  y 0.0 px   100 %");
  for (const Vector2d& outside : {Vector2d(-0.6, 0), {3.5, 0}, {0, 2.6}})
    EXPECT_EQ(text_at(outside, bgr), "");
}

TEST(PixelText, ShowsTheDistanceOfThePlaneNearItsTracks) {
  const Inspection inspection = made_inspection();
  constexpr int kFrame = 20;
  const int in_window = kFrame - inspection.window->start;
  const auto& points = inspection.initialization->points;
  const auto is_inlier = [&](const MapPoint& point) {
    return inspection.window->inlier[in_window][point.track];
  };
  const auto point = std::ranges::find_if(points, is_inlier);
  ASSERT_NE(point, points.end());
  const auto text_of = [&](const Inspection& shown, int frame) {
    const Vector2d raw_px = inspection.tracks->raw_px[in_window].col(point->track);
    return pixel_text({&shown, frame, inspection.recording->camera, {}, raw_px, 1});
  };
  // The track's map point has the same distance.
  const double away = (point->position - inspection.initialization->cameras[in_window].p_wc).norm();
  EXPECT_THAT(text_of(inspection, kFrame),
              AllOf(HasSubstr(fmt::format("{:.1f}", away)), HasSubstr(" d away on plane 1")));
  EXPECT_THAT(text_of(inspection, 0), Not(HasSubstr("away"))) << "outside of the window";
  EXPECT_THAT(text_of(made_inspection({.ok = false}), kFrame), Not(HasSubstr("plane")));
}

TEST(DistanceText, IsInMetersIfTheAccelerometerDeterminesTheScale) {
  Inspection inspection = made_inspection();
  const Eigen::Vector3d a(0.1, 0, 1), b(0.1, 0.6, 1.8);
  EXPECT_EQ(distance_text(inspection, a, b), "1.000 d");
  InertialAlignment& inertial = inspection.inertial.emplace();
  inertial.ok = inertial.scale_known = true;
  inertial.scale = 0.25;
  EXPECT_EQ(distance_text(inspection, a, b), "250 mm");
}

TEST(DashPattern, DashesBendWithTheLine) {
  const std::vector<Vector2d> line = {{0, 0}, {5, 0}, {5, 5}};
  EXPECT_THAT(dashes_along(line, std::vector<double>{3, 1}),
              ElementsAre(Pair(Vector2d(0, 0), Vector2d(3, 0)),
                          Pair(Vector2d(4, 0), Vector2d(5, 0)),
                          Pair(Vector2d(5, 0), Vector2d(5, 2)),
                          Pair(Vector2d(5, 3), Vector2d(5, 5))));
}

TEST(DashPattern, EndsDespiteRounding) {
  std::vector<Vector2d> line;
  for (int i = 0; i < 2000; ++i) line.emplace_back(0.1 * i, 0.1 * (i % 7));
  EXPECT_LT(dashes_along(line, std::vector<double>{0.1, 0.3}).size(), 10000U);
  const std::vector<Vector2d> point = {{1, 1}, {1, 1}};
  EXPECT_THAT(dashes_along(point, std::vector<double>{3, 1}), IsEmpty());
}

TEST(VerdictStyle, ShapesAndColorsDiffer) {
  const SignStyle a = style_of(ready), b = style_of(weak), c = style_of(degenerate);
  EXPECT_EQ(std::set({a.sign, b.sign, c.sign}).size(), 3U);
  EXPECT_EQ(std::set({a.rgb, b.rgb, c.rgb}).size(), 3U);
}

TEST(VerdictStyle, TextLeavesOutUnknownNumbers) {
  EXPECT_EQ(verdict_text({weak, "", 0.31, 1.2, 0.4, 0.1}),
            "weak, normal \u00b10.310\u00b0, rotation alone leaves 1.20 px where noise is 0.40 px, "
            "moved 0.100 d");
  EXPECT_EQ(verdict_text(Verdict()), "degenerate");
}

TEST(VerdictStyle, RunsCountFramesOfTheWindow) {
  std::vector<Verdict> growth(5);
  growth[2].readiness = weak;
  growth[3].readiness = growth[4].readiness = ready;
  EXPECT_THAT(
      verdict_runs(growth),
      ElementsAre(VerdictRun{1, 2, degenerate}, VerdictRun{3, 3, weak}, VerdictRun{4, 5, ready}));
  EXPECT_TRUE(verdict_runs({}).empty());
}

TEST(TrackColors, GrowBrighterWithTheirNumber) {
  const Inspection inspection = made_inspection();
  EXPECT_EQ(track_colors(inspection, Coloring::plane), nullptr);
  for (const Coloring coloring : {Coloring::residual, Coloring::depth, Coloring::life}) {
    const auto colors = track_colors(inspection, coloring);
    ASSERT_NE(colors, nullptr);
    ASSERT_EQ(std::ssize(colors->values), inspection.tracks->track_count());
    EXPECT_LT(colors->low, colors->high);
    std::multimap<double, double> seen;  // brightness, 0 to 255, by value
    for (int track = 0; track < inspection.tracks->track_count(); ++track)
      if (const std::uint32_t rgb = colors->rgb(track); colors->values[track])
        seen.emplace(*colors->values[track],
                     255 * (0.2126 * red(rgb) + 0.7152 * green(rgb) + 0.0722 * blue(rgb)));
    double brightest = 0;
    for (const auto& [value, brightness] : seen) {
      EXPECT_LE(brightest, brightness + 1) << "rounded";
      brightest = std::max(brightest, brightness);
    }
    EXPECT_EQ(legend_rows(*colors).size(), 2U);
  }
}

TEST(TrackColors, HaveTheNumbersOfTheResult) {
  const Inspection inspection = made_inspection();
  const auto depth = track_colors(inspection, Coloring::depth);
  for (const MapPoint& point : inspection.initialization->points)
    EXPECT_NEAR(depth->values[point.track].value(), point.position.z(), 1e-9);
  const auto life = track_colors(inspection, Coloring::life);
  for (int column = 0; column < inspection.tracks->track_count(); ++column) {
    const auto seen = [&](const auto& raw_px) { return raw_px.col(column).allFinite(); };
    EXPECT_EQ(life->values[column], std::ranges::count_if(inspection.tracks->raw_px, seen));
  }
}

TEST(TrackColors, AreGrayIfUnknown) {
  const auto colors = track_colors(made_inspection({.ok = false}), Coloring::residual);
  EXPECT_EQ(colors->rgb(0), color_of(Role::text_dim));
  ASSERT_EQ(legend_rows(*colors).size(), 1U);
  EXPECT_EQ(legend_rows(*colors)[0].text, "residual unknown");
}

}  // namespace
}  // namespace gpo
