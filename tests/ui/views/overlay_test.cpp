// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/overlay.h"

#include "engine/window/tracks.h"
#include "tests/ui/made_inspection.h"
#include "ui/views/image/pointing.h"

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using enum Readiness;

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
  EXPECT_TRUE(a.sign != b.sign && b.sign != c.sign && a.sign != c.sign);
  EXPECT_TRUE(a.rgb != b.rgb && b.rgb != c.rgb && a.rgb != c.rgb);
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

TEST(VerdictStyle, WholeWindowHasTheVerdictOfItsResult) {
  Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  auto result = std::make_shared<Initialization>(*inspection.initialization);
  result->verdict->readiness = weak;
  inspection.initialization = result;
  const std::vector<Verdict> shown = shown_growth(inspection);
  ASSERT_EQ(shown.size(), inspection.growth.size());
  EXPECT_EQ(inspection.growth.back().readiness, ready);
  EXPECT_EQ(shown.back().readiness, weak);
  EXPECT_EQ(shown[shown.size() - 2].readiness, ready);
  result->verdict.reset();
  EXPECT_EQ(shown_growth(inspection).back().readiness, ready) << "the result has no verdict";
}

double brightness_of(std::uint32_t rgb) {
  return 0.2126 * ((rgb >> 16) & 255) + 0.7152 * ((rgb >> 8) & 255) + 0.0722 * (rgb & 255);
}

TEST(TrackColors, GrowBrighterWithTheirNumber) {
  const Inspection inspection = made_inspection();
  EXPECT_EQ(track_colors(inspection, Coloring::plane), nullptr);
  for (const Coloring coloring : {Coloring::residual, Coloring::depth, Coloring::life}) {
    const auto colors = track_colors(inspection, coloring);
    ASSERT_NE(colors, nullptr);
    ASSERT_EQ(std::ssize(colors->values), inspection.tracks->track_count());
    EXPECT_LT(colors->low, colors->high);
    std::vector<std::pair<double, double>> seen;  // value and brightness
    for (int track = 0; track < inspection.tracks->track_count(); ++track)
      if (const auto& value = colors->values[track])
        seen.emplace_back(*value, brightness_of(colors->rgb(track)));
    std::ranges::sort(seen);
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
    int frames = 0;
    for (int i = 0; i < inspection.window->frame_count(); ++i)
      frames += inspection.tracks->seen(i, column) ? 1 : 0;
    EXPECT_EQ(life->values[column], frames);
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
