// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/tracks.h"
#include "tests/ui/made_inspection.h"
#include "ui/views/image/pointing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr int kShownFrame = 20;

TEST(PixelText, TellsPlaceValueAndZoom) {
  const Camera camera{.width = 4, .height = 3, .fx = 1, .fy = 1};
  cv::Mat bgr(3, 4, CV_8UC3, cv::Scalar(10, 20, 30));
  bgr.at<cv::Vec3b>(2, 3) = {7, 7, 7};
  EXPECT_EQ(pixel_text(nullptr, 0, camera, bgr, {0.25, 1.75}, 2.5),
            "x 0.2  y 1.8 px   RGB 30 20 10   250 %");
  EXPECT_EQ(pixel_text(nullptr, 0, camera, bgr, {2.6, 2.4}, 1), "x 2.6  y 2.4 px   gray 7   100 %")
      << "the pixel's middle is a whole number";
  EXPECT_EQ(pixel_text(nullptr, 0, camera, {}, {-0.5, 0}, 1), "x -0.5  y 0.0 px   100 %");
  for (const Eigen::Vector2d& outside : {Eigen::Vector2d(-0.6, 0), {3.5, 0}, {0, 2.6}})
    EXPECT_EQ(pixel_text(nullptr, 0, camera, bgr, outside, 1), "");
}

TEST(PixelText, TellsHowFarThePlaneIsWhereATrackIsOnIt) {
  const Inspection inspection = made_inspection();
  const Camera& camera = inspection.recording->camera;
  const int in_window = kShownFrame - inspection.window->start;
  int inlier = 0;
  while (!inspection.tracks->seen(in_window, inlier) ||
         !inspection.window->inlier[in_window][inlier])
    ++inlier;
  const Eigen::Vector2d at = inspection.tracks->raw_px[in_window].col(inlier);
  // The map point that the track has is as far away.
  const auto& points = inspection.initialization->points;
  const auto point = std::ranges::find(points, inlier, &MapPoint::track);
  ASSERT_NE(point, points.end());
  const double away = (point->position - inspection.initialization->cameras[in_window].p_wc).norm();
  EXPECT_THAT(pixel_text(&inspection, kShownFrame, camera, {}, at, 1),
              HasSubstr(fmt::format("{:.1f}", away)));
  EXPECT_THAT(pixel_text(&inspection, kShownFrame, camera, {}, at, 1),
              HasSubstr(" d away on plane 1"));
  EXPECT_THAT(pixel_text(&inspection, 0, camera, {}, at, 1), Not(HasSubstr("away")))
      << "outside of the window";
  const Inspection failed = made_inspection({.ok = false});
  EXPECT_THAT(pixel_text(&failed, kShownFrame, camera, {}, at, 1), Not(HasSubstr("plane")));
}

}  // namespace
}  // namespace gpo
