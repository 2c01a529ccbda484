// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/pointing.h"

#include "engine/window/tracks.h"
#include "tests/ui/made_inspection.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(PixelText, ShowsPlaceValueAndZoom) {
  const Camera camera{.width = 4, .height = 3, .fx = 1, .fy = 1};
  cv::Mat bgr(3, 4, CV_8UC3, cv::Scalar(10, 20, 30));
  bgr.at<cv::Vec3b>(2, 3) = {7, 7, 7};
  const auto text_at = [&](const Vector2d& raw_px, const cv::Mat& pixels, double scale = 1) {
    return pixel_text({.inspection = nullptr,
                       .frame = 0,
                       .camera = camera,
                       .bgr = pixels,
                       .raw_px = raw_px,
                       .scale = scale});
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
  int inlier = 0;
  while (!inspection.tracks->seen(in_window, inlier) ||
         !inspection.window->inlier[in_window][inlier])
    ++inlier;
  const auto text_of = [&](const Inspection& shown, int frame) {
    return pixel_text({.inspection = &shown,
                       .frame = frame,
                       .camera = inspection.recording->camera,
                       .bgr = {},
                       .raw_px = inspection.tracks->raw_px[in_window].col(inlier),
                       .scale = 1});
  };
  // The track's map point has the same distance.
  const auto& points = inspection.initialization->points;
  const auto point = std::ranges::find(points, inlier, &MapPoint::track);
  ASSERT_NE(point, points.end());
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
  InertialAlignment inertial;
  inertial.ok = inertial.scale_known = true;
  inertial.scale = 0.25;
  inspection.inertial = inertial;
  EXPECT_EQ(distance_text(inspection, a, b), "250 mm");
}

}  // namespace
}  // namespace gpo
