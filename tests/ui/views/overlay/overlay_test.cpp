// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/overlay.h"

#include "engine/window/tracks.h"
#include "tests/ui/made_inspection.h"
#include "ui/views/overlay/plane_style.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using enum Readiness;

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
  const ReadinessStyle a = style_of(ready), b = style_of(weak), c = style_of(degenerate);
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
