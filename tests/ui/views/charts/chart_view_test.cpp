// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/chart_view.h"

#include "tests/ui/gl_test.h"
#include "ui/context/framebuffer.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <imgui.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

constexpr std::uint32_t kRed = 0xFF0000;
constexpr int kWidth = 400, kHeight = 200;
constexpr double kTop = 24;

class ChartViewTest : public DrawingTest {};

Chart chart_of(std::vector<double> x, std::vector<double> y, bool logarithmic = false) {
  return {"Error", "frame", "error [px]", logarithmic, {{"gpo", kRed, false, x, y, {}, {}}}};
}

/// The middle of what is as red as the curve [px], the corner of a pixel being its origin. Not of
/// the edge, which is smoothed on one side of a point only.
Eigen::Vector2d middle_of_red(const cv::Mat& picture) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const auto& bgr = picture.at<cv::Vec3b>(y, x);
      if (bgr[2] < 240 || bgr[1] > 15) continue;
      sum += Eigen::Vector2d(x + 0.5, y + 0.5);
      ++count;
    }
  EXPECT_GT(count, 4) << "nothing is red";
  return sum / std::max(1, count);
}

TEST_F(ChartViewTest, APointIsDrawnWhereTheMappingSays) {
  OffscreenContext context(kWidth, kHeight);
  context.bind();
  ChartView view;
  for (const bool logarithmic : {false, true}) {
    // The gaps stretch the x axis, and the y axis is known from the first point alone.
    const Chart chart = chart_of({2, 7, 9}, {NAN, 30, NAN}, logarithmic);
    const unsigned texture = view.render(chart, kWidth, kHeight, 1, kTop);
    const cv::Mat picture = read_texture(texture, kWidth, kHeight);
    keep(logarithmic ? "chart-log" : "chart", picture);
    EXPECT_LT((middle_of_red(picture) - view.mapping().px(7, 30)).norm(), 0.8);
  }
}

TEST_F(ChartViewTest, TheMappingCanBeTurnedRound) {
  OffscreenContext context(kWidth, kHeight);
  context.bind();
  ChartView view;
  for (const bool logarithmic : {false, true}) {
    view.render(chart_of({1, 5}, {0.1, 20}, logarithmic), kWidth, kHeight, 1, kTop);
    const ChartMapping& to = view.mapping();
    const Eigen::Vector2d at = to.px(3, 0.7);
    EXPECT_NEAR(to.x_value(at.x()), 3, 1e-9);
    EXPECT_NEAR(to.y_value(at.y()), 0.7, 1e-9);
    EXPECT_TRUE(to.inside(at));
    EXPECT_FALSE(to.inside(to.px(3, to.y_high * 1.2)));
    EXPECT_LT(to.y_px(20), to.y_px(0.1)) << "y is down";
  }
}

/// Three that lie upon one another, the second but at some places; a fourth that only crosses.
TEST_F(ChartViewTest, EqualCurvesAreToldApart) {
  OffscreenContext context(kWidth, kHeight);
  context.bind();
  ChartView view;
  Chart chart = chart_of({1, 2, 3, 4, 5}, {1, 4, 3, 3, 5});
  constexpr std::uint32_t kGreen = 0x00FF00, kBlue = 0x0000FF, kYellow = 0xFFFF00;
  chart.curves.push_back({"pba", kGreen, false, {2, 3, 4, 5}, {4, 3, 3, 5}, {}, {}});
  chart.curves.push_back({"ba", kBlue, false, {1, 2, 3, 4, 5}, {1, 4, 3, 3, 5}, {}, {}});
  chart.curves.push_back({"pnp", kYellow, false, {1, 5}, {5, 1}, {}, {}});
  const cv::Mat picture =
      read_texture(view.render(chart, kWidth, kHeight, 1, kTop), kWidth, kHeight);
  keep("chart-equal", picture);
  // Half of the line is the lowest one's, a quarter is each of the others'.
  const auto at_3 = static_cast<int>(view.mapping().px(3, 3).x());
  const cv::Mat right = picture.colRange(at_3, kWidth);
  const double alone = count_pixels(right, kYellow, 40);
  for (const std::uint32_t rgb : {kRed, kGreen, kBlue})
    EXPECT_GT(count_pixels(right, rgb, 40), 0.2 * alone) << std::hex << rgb;
}

TEST_F(ChartViewTest, WhatIsUnchangedIsNotRenderedAgain) {
  OffscreenContext context(kWidth, kHeight);
  context.bind();
  ChartView view;
  const auto render = [&](const Chart& chart, int width) {
    EXPECT_NE(view.render(chart, width, kHeight, 1, kTop), 0U);
    return view.revision();
  };
  const Chart with_gap = chart_of({1, 2, 3}, {1, NAN, 2});
  const std::size_t first = render(with_gap, kWidth);
  EXPECT_EQ(render(with_gap, kWidth), first) << "a gap is no change";
  EXPECT_EQ(render(chart_of({1, 2, 3}, {1, 1.5, 2}), kWidth), first + 1);
  EXPECT_EQ(render(chart_of({1, 2, 3}, {1, 1.5, 2}), kWidth / 2), first + 2);
  EXPECT_EQ(view.render(with_gap, 0, kHeight, 1, kTop), 0U);
}

TEST_F(ChartViewTest, EachOfTwoKeepsItsOwnPicture) {
  OffscreenContext context(kWidth, kHeight);
  context.bind();
  ChartView left, right;
  const Chart low = chart_of({1, 2, 3}, {NAN, 1, 2}), high = chart_of({1, 2, 3}, {5, 1, NAN});
  const cv::Mat alone =
      read_texture(left.render(low, kWidth, kHeight, 1, kTop), kWidth, kHeight).clone();
  right.render(high, kWidth, kHeight, 1, kTop);
  const cv::Mat still = read_texture(left.render(low, kWidth, kHeight, 1, kTop), kWidth, kHeight);
  EXPECT_TRUE(same_bytes(alone, still));
}

/// With Dear ImGui around it: titles, legend, and where the values are on the screen.
struct Drawn {
  cv::Mat picture;
  ChartMapping to;
};
Drawn draw(const Chart& chart, float scale) {
  const cv::Size size(static_cast<int>(kWidth * scale), static_cast<int>(kHeight * scale));
  OffscreenContext context(size.width, size.height);
  Gui gui(scale);
  ChartView view;
  context.bind();
  Drawn drawn;
  gui.begin_frame(size.width, size.height);
  drawn.to = draw_chart_view(*ImGui::GetBackgroundDrawList(),
                             {{20, 10}, {size.width - 40.0, size.height - 20.0}},
                             view,
                             chart);
  draw_chart_cursor(*ImGui::GetBackgroundDrawList(), drawn.to, 7, color_of(Role::accent));
  gui.end_frame();
  drawn.picture = context.read_bgr();
  return drawn;
}

TEST_F(ChartViewTest, TheMappingOfTheScreenKnowsWhereTheChartStands) {
  for (const float scale : {1.0F, 2.0F}) {
    Chart chart = chart_of({2, 7, 9}, {NAN, 30, NAN});
    const Drawn drawn = draw(chart, scale);
    keep("chart-drawn", drawn.picture);
    EXPECT_LT((middle_of_red(drawn.picture) - drawn.to.px(7, 30)).norm(), 1.2 * scale);
  }
}

TEST_F(ChartViewTest, LegendAndEmptyChartHaveTheirPlace) {
  Chart chart = chart_of({1, 7, 9}, {3, 4, 5});
  const double low = draw(chart, 1).to.height;
  for (const char* name : {"bound of what is possible", "another long name", "a third one"})
    chart.curves.push_back({name, 0x00FF00, true, {1, 9}, {6, 6}, {}, {}});
  const Drawn drawn = draw(chart, 1);
  keep("chart-legend", drawn.picture);
  EXPECT_GT(drawn.to.height, low) << "the legend is above the axes, which are lower then";
  keep("chart-empty", draw(chart_of({}, {}), 1).picture);
}

TEST(ChartValues, AreThoseOfTheNearestPoint) {
  Chart chart = chart_of({1, 2, 3}, {4, 5, NAN});
  chart.curves.push_back({"ba", 0, false, {1, 3}, {7, 8}, {}, {}});
  EXPECT_EQ(chart_values_at(chart, 1.2), "frame: 1\nerror [px]\ngpo: 4\nba: 7");
  EXPECT_EQ(chart_values_at(chart, 2.2), "frame: 2\nerror [px]\ngpo: 5");
  EXPECT_EQ(chart_values_at(chart, 9), "frame: 3\nerror [px]\nba: 8");
  EXPECT_EQ(chart_values_at(chart_of({}, {}), 1), "");
  const Chart steps = chart_of({0, 1, 1, 2}, {4, 4, 5, 5});
  EXPECT_EQ(chart_values_at(steps, 0.9), "frame: 1\nerror [px]\ngpo: 4");
  EXPECT_EQ(chart_values_at(steps, 1.1), "frame: 1\nerror [px]\ngpo: 5");
}

}  // namespace
}  // namespace gpo
