// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/chart_view.h"

#include "tests/ui/gl_test.h"
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

class ChartViewTest : public DrawingTest {};

Chart chart_of(std::vector<double> x, std::vector<double> y, bool logarithmic = false) {
  return {"Error", "frame", "error [px]", logarithmic, {{"gpo", kRed, false, x, y, {}, {}}}};
}

/// Returns the center of the pixels of the curve's color [px], from the image's corner. Leaves out
/// edges, which are smoothed on one side of a point only.
Eigen::Vector2d middle_of_red(const cv::Mat& image) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const auto& bgr = image.at<cv::Vec3b>(y, x);
      if (bgr[2] < 240 || bgr[1] > 15) continue;
      sum += Eigen::Vector2d(x + 0.5, y + 0.5);
      ++count;
    }
  EXPECT_GT(count, 4) << "no red pixels";
  return sum / std::max(1, count);
}

ChartRequest request_of(const Chart& chart) { return {chart, {kWidth, kHeight}, 1, true}; }

TEST(WindowChart, DrawsAPointWhereTheInvertibleMappingPutsIt) {
  for (const bool logarithmic : {false, true}) {
    const Chart chart = chart_of({2, 7, 9}, {NAN, 30, NAN}, logarithmic);
    const auto [image, to] = draw_window_chart(request_of(chart));
    keep(logarithmic ? "chart-log" : "chart", image);
    const Eigen::Vector2d at = to.px(7, 30);
    EXPECT_LT((middle_of_red(image) - at).norm(), 0.8);
    EXPECT_NEAR(to.x_value(at.x()), 7, 1e-9);
    EXPECT_NEAR(to.y_value(at.y()), 30, 1e-9);
    EXPECT_TRUE(to.inside(at));
    EXPECT_FALSE(to.inside(to.px(7, to.y_high * 1.2)));
    EXPECT_LT(to.y_px(31), to.y_px(30)) << "y is down";
  }
}

/// Three curves are equal, the second only in part; a fourth crosses them.
TEST(WindowChart, ShowsEqualCurvesAsDashes) {
  Chart chart = chart_of({1, 2, 3, 4, 5}, {1, 4, 3, 3, 5});
  constexpr std::uint32_t kGreen = 0x00FF00, kBlue = 0x0000FF, kYellow = 0xFFFF00;
  chart.curves.push_back({"pba", kGreen, false, {2, 3, 4, 5}, {4, 3, 3, 5}, {}, {}});
  chart.curves.push_back({"ba", kBlue, false, {1, 2, 3, 4, 5}, {1, 4, 3, 3, 5}, {}, {}});
  chart.curves.push_back({"pnp", kYellow, false, {1, 5}, {5, 1}, {}, {}});
  ChartRequest request = request_of(chart);
  request.legend = false;
  const auto [image, to] = draw_window_chart(request);
  keep("chart-equal", image);
  // The lowest one has half of the line, the others a quarter each.
  const cv::Mat right = image.colRange(static_cast<int>(to.px(3, 3).x()), kWidth);
  const double alone = count_pixels(right, kYellow, 40);
  for (const std::uint32_t rgb : {kRed, kGreen, kBlue})
    EXPECT_GT(count_pixels(right, rgb, 40), 0.2 * alone) << std::hex << rgb;
}

TEST(WindowChart, HasHollowPointsForFewWindows) {
  Chart chart = chart_of({1, 2, 3}, {3, 3, 3});
  for (const int count : {9, 1}) {
    chart.curves[0].counts = {9, count, 9};
    const auto [image, to] = draw_window_chart(request_of(chart));
    const Eigen::Vector2d at = to.px(2, 3);
    const cv::Vec3b middle =
        image.at<cv::Vec3b>(static_cast<int>(at.y()), static_cast<int>(at.x()));
    EXPECT_EQ(middle == cv::Vec3b(0, 0, 255), count == 9);
  }
}

TEST(WindowChart, HasThemesAndScales) {
  ChartRequest request = request_of(chart_of({1, 2, 3}, {1, 3, 2}));
  for (const Theme theme : {Theme::dark, Theme::light}) {
    request.theme = theme;
    const cv::Mat image = draw_window_chart(request).bgr;
    EXPECT_GT(count_pixels(image, color_of(Role::panel, theme), 0), kWidth * kHeight / 2);
    EXPECT_GT(count_pixels(image, color_of(Role::text, theme), 20), 20);
  }
  const double left = draw_window_chart(request).mapping.left;
  request.scale = 2;
  EXPECT_EQ(draw_window_chart(request).mapping.left, 2 * left);
}

TEST_F(ChartViewTest, DrawsOnlyAfterAChange) {
  OffscreenContext context(kWidth, kHeight);
  context.bind();
  ChartView view;
  const auto revision = [&](const ChartRequest& request) {
    view.update(request);
    return view.texture().revision();
  };
  ChartRequest request = request_of(chart_of({1, 2, 3}, {1, NAN, 2}));
  const std::size_t first = revision(request);
  EXPECT_EQ(revision(request), first) << "a gap is no change";
  request.chart = chart_of({1, 2, 3}, {1, 1.5, 2});
  EXPECT_EQ(revision(request), first + 1);
  request.size.width /= 2;
  EXPECT_EQ(revision(request), first + 2);
  request.chart.title = "another title";
  EXPECT_EQ(revision(request), first + 3);
  request.theme = Theme::light;
  EXPECT_EQ(revision(request), first + 4);
}

/// A chart in a window.
struct Drawn {
  cv::Mat image;
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
  drawn.image = context.read_bgr();
  return drawn;
}

TEST_F(ChartViewTest, MapsValuesToTheScreen) {
  for (const float scale : {1.0F, 2.0F}) {
    Chart chart = chart_of({2, 7, 9}, {NAN, 30, NAN});
    const Drawn drawn = draw(chart, scale);
    keep("chart-drawn", drawn.image);
    EXPECT_LT((middle_of_red(drawn.image) - drawn.to.px(7, 30)).norm(), 1.2 * scale);
  }
}

TEST_F(ChartViewTest, MakesRoomForALegend) {
  Chart chart = chart_of({1, 7, 9}, {3, 4, 5});
  const double low = draw(chart, 1).to.height;
  for (const char* name : {"bound of what is possible", "another long name", "a third one"})
    chart.curves.push_back({name, 0x00FF00, true, {1, 9}, {6, 6}, {}, {}});
  const Drawn drawn = draw(chart, 1);
  keep("chart-legend", drawn.image);
  EXPECT_GT(drawn.to.height, low) << "the legend is above the axes";
  keep("chart-empty", draw(chart_of({}, {}), 1).image);
}

TEST(ChartValues, AreOfTheNearestPoint) {
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

TEST(ChartCsv, HasALinePerPointWithUnits) {
  Chart chart{"", "frames", "error, all [px]", false, {}};
  chart.curves.push_back({.name = "gpo", .x = {1, 2.5}, .y = {0.25, 3}, .lower = {}, .upper = {}});
  EXPECT_EQ(to_csv(chart), "curve,frames,error; all [px]\ngpo,1,0.25\ngpo,2.5,3\n");
  chart.curves.push_back({.name = "ba", .x = {1}, .y = {NAN}, .lower = {0.5}, .upper = {2}});
  EXPECT_EQ(to_csv(chart),
            "curve,frames,error; all [px],lower,upper\ngpo,1,0.25,,\ngpo,2.5,3,,\nba,1,,0.5,2\n");
}

}  // namespace
}  // namespace gpo
