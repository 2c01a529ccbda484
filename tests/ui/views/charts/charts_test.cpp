// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/charts.h"

#include "engine/geometry/statistics.h"
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"

#include <numeric>

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::SizeIs;

constexpr std::uint32_t kRed = 0xFF0000;
constexpr int kWidth = 400, kHeight = 200;

class ChartViewTest : public DrawingTest {};

Chart chart_of(std::vector<double> x, std::vector<double> y, bool logarithmic = false) {
  return {"Error", "frame", "error [px]", logarithmic, {{"gpo", kRed, false, x, y, {}, {}}}};
}

/// Returns the center of the pixels of the curve's color [px], from the image's corner. Leaves out
/// edges, which are smoothed on one side of a point only.
Eigen::Vector2d middle_of_red(const cv::Mat& image) {
  cv::Mat1b red;
  cv::inRange(image, cv::Scalar(0, 0, 240), cv::Scalar(255, 15, 255), red);
  const cv::Moments sums = cv::moments(red, true);
  EXPECT_GT(sums.m00, 4) << "no red pixels";
  return Eigen::Vector2d(sums.m10, sums.m01) / std::max(1.0, sums.m00) +
         Eigen::Vector2d::Constant(0.5);
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
    const Eigen::Vector2i at = to.px(2, 3).cast<int>();
    EXPECT_EQ(image.at<cv::Vec3b>(at.y(), at.x()) == cv::Vec3b(0, 0, 255), count == 9);
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
  ChartRequest request = request_of(chart_of({1, 2, 3}, {1, NAN, 2}));
  const auto revision = [&] {
    view.update(request);
    return view.texture().revision();
  };
  std::size_t expected = revision();
  EXPECT_EQ(revision(), expected) << "a gap is no change";
  request.chart = chart_of({1, 2, 3}, {1, 1.5, 2});
  EXPECT_EQ(revision(), ++expected);
  request.size.width /= 2;
  EXPECT_EQ(revision(), ++expected);
  request.chart.title = "another title";
  EXPECT_EQ(revision(), ++expected);
  request.theme = Theme::light;
  EXPECT_EQ(revision(), ++expected);
}

ChartImage draw(const Chart& chart, float scale) {
  const cv::Size size(static_cast<int>(kWidth * scale), static_cast<int>(kHeight * scale));
  OffscreenContext context(size.width, size.height);
  Gui gui(scale);
  ChartView view;
  context.bind();
  gui.begin_frame(size.width, size.height);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ScreenRect rect{{20, 10}, {size.width - 40.0, size.height - 20.0}};
  const ChartMapping to = draw_chart_view({list, rect}, view, chart, true);
  draw_chart_cursor(list, to, 7, color_of(Role::accent));
  gui.end_frame();
  return {context.read_bgr(), to};
}

TEST_F(ChartViewTest, MapsValuesToTheScreen) {
  for (const float scale : {1.0F, 2.0F}) {
    const auto [image, to] = draw(chart_of({2, 7, 9}, {NAN, 30, NAN}), scale);
    keep("chart-drawn", image);
    EXPECT_LT((middle_of_red(image) - to.px(7, 30)).norm(), 1.2 * scale);
  }
}

TEST_F(ChartViewTest, MakesRoomForALegend) {
  Chart chart = chart_of({1, 7, 9}, {3, 4, 5});
  const double low = draw(chart, 1).mapping.height;
  for (const char* name : {"bound of what is possible", "another long name", "a third one"})
    chart.curves.push_back({name, 0x00FF00, true, {1, 9}, {6, 6}, {}, {}});
  const auto [image, to] = draw(chart, 1);
  keep("chart-legend", image);
  EXPECT_GT(to.height, low) << "the legend is above the axes";
  keep("chart-empty", draw(chart_of({}, {}), 1).bgr);
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
  chart.curves.push_back({.name = "gpo", .x = {1, 2.5}, .y = {0.25, 3}});
  EXPECT_EQ(to_csv(chart), "curve,frames,error; all [px]\ngpo,1,0.25\ngpo,2.5,3\n");
  chart.curves.push_back({.name = "ba", .x = {1}, .y = {NAN}, .lower = {0.5}, .upper = {2}});
  EXPECT_EQ(to_csv(chart),
            "curve,frames,error; all [px],lower,upper\ngpo,1,0.25,,\ngpo,2.5,3,,\nba,1,,0.5,2\n");
}

class ResidualCharts : public testing::Test {
 protected:
  Chart histogram(int frame_in_window) const {
    return residual_histogram(residuals, inspection, start + frame_in_window);
  }
  /// Expects two histograms of 100 %; each bin has two points.
  static void expect_two_complete(const Chart& chart) {
    ASSERT_EQ(chart.curves.size(), 2U);
    for (const Curve& curve : chart.curves)
      EXPECT_NEAR(std::reduce(curve.y.begin(), curve.y.end()) / 2, 100, 1e-9) << curve.name;
  }

  const Inspection inspection = made_inspection({.estimate_error = 1});
  const int start = inspection.window->start;
  WindowResiduals residuals = window_residuals(inspection);
};

TEST_F(ResidualCharts, HistogramsHaveAllResidualsOfWindowAndFrame) {
  const Chart chart = histogram(9);
  expect_two_complete(chart);
  for (const Curve& curve : chart.curves) EXPECT_EQ(curve.upper, curve.y);
  EXPECT_THAT(
      chart.curves[1].name,
      AllOf(HasSubstr(std::to_string(start + 9)), HasSubstr(std::to_string(residuals[9].size()))));
  EXPECT_EQ(histogram(0).curves.size(), 1U) << "the reference frame";
  EXPECT_EQ(histogram(-1).curves.size(), 1U);
}

TEST_F(ResidualCharts, LastBinIncludesLargerResiduals) {
  residuals.assign(3, std::vector<double>(300, 0.5));
  residuals[1].front() = 1e12;
  residuals[1].back() = INFINITY;
  const Chart chart = histogram(1);
  expect_two_complete(chart);
  EXPECT_NEAR(chart.curves[1].y.back(), 100 * 2 / 300.0, 1e-9);
}

TEST_F(ResidualCharts, ShowTheBulkInSeveralBinsBesideManyLargeResiduals) {
  residuals.assign(3, {});
  for (int i = 0; i < 1000; ++i)
    for (auto& frame : residuals) frame.push_back(i < 950 ? 0.001 * (i % 100) : 5);
  const Chart chart = histogram(1);
  const Curve& window = chart.curves[0];
  EXPECT_LT(*std::ranges::max_element(window.y), 40);
  EXPECT_NEAR(window.y.back(), 5, 1e-9) << "the last bin counts all larger ones";
}

TEST_F(ResidualCharts, LogarithmicHistogramsHaveNoZeros) {
  const Chart chart = residual_histogram(residuals, inspection, start + 9, true);
  EXPECT_TRUE(chart.logarithmic);
  for (const Curve& curve : chart.curves) EXPECT_GT(*std::ranges::min_element(curve.lower), 0);
  EXPECT_FALSE(histogram(9).logarithmic);
}

TEST_F(ResidualCharts, HaveTheEnginesRmsAndTheTracksResiduals) {
  const TrackLife track = track_life(inspection, 3);
  const Chart chart = rms_chart(residuals, inspection, &track);
  ASSERT_EQ(chart.curves.size(), 2U);
  ASSERT_EQ(static_cast<int>(chart.curves[0].y.size()), inspection.window->frame_count());
  for (int i = 0; i < inspection.window->frame_count(); ++i)
    EXPECT_DOUBLE_EQ(chart.curves[0].y[i], root_mean_square(residuals_px(inspection, i))) << i;
  EXPECT_EQ(chart.curves[0].x.front(), start);
  EXPECT_EQ(chart.curves[1].x.size(), track.frames.size());
  EXPECT_EQ(rms_chart(residuals, inspection, nullptr).curves.size(), 1U);
}

TEST_F(ResidualCharts, AreEmptyWithoutAResult) {
  const Inspection failed = made_inspection({.ok = false});
  residuals = window_residuals(failed);
  EXPECT_TRUE(residuals.empty());
  EXPECT_TRUE(residual_histogram(residuals, failed, 10).curves.empty());
  EXPECT_TRUE(rms_chart(residuals, failed, nullptr).curves.empty());
}

TEST(SolverCharts, HaveACurvePerRun) {
  const auto result = [](std::vector<SolverStep> trace) {
    Inspection inspection;
    Initialization initialization;
    initialization.solver.trace = std::move(trace);
    inspection.initialization = std::make_shared<const Initialization>(initialization);
    return std::make_shared<const Inspection>(inspection);
  };
  const std::vector<SolverStep> trace = {{8, 4, 0, {}}, {2, 1, 0.5, {}}, {1, 0.1, 0.25, {}}};
  const std::array results = {ShownResult{"gpo", 0x00FF00, result(trace)},
                              ShownResult{"dbscan", 0, result({})}};
  const auto charts = solver_charts(results);
  const std::vector<double> values[] = {{8, 2, 1}, {4, 1, 0.1}, {0, 0.5, 0.25}};
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(charts[k].logarithmic);
    ASSERT_EQ(charts[k].curves.size(), 1U) << "runs without iterations are left out";
    EXPECT_EQ(charts[k].curves[0].name, "gpo");
    EXPECT_EQ(charts[k].curves[0].rgb, 0x00FF00U);
    EXPECT_THAT(charts[k].curves[0].x, ElementsAre(0, 1, 2));
    EXPECT_EQ(charts[k].curves[0].y, values[k]);
    EXPECT_THAT(charts[k].y_label, HasSubstr("[")) << "a unit";
  }
}

TEST(AxisTicks, LinearAreRoundNumbersWithinTheRange) {
  const AxisTicks ticks = linear_ticks(4.25, 30.75, 7);
  EXPECT_TRUE(ticks.low == 4.25 && ticks.high == 30.75);
  EXPECT_THAT(ticks.labels, ElementsAre("5", "10", "15", "20", "25", "30"));
  EXPECT_THAT(linear_ticks(0, 0.3, 4).labels, ElementsAre("0", "0.1", "0.2", "0.3"));
  for (double high = 0.01; high < 1e4; high *= 1.7)
    EXPECT_LE(linear_ticks(0, high, 5).values.size(), 6U) << high;
}

TEST(AxisTicks, LogarithmicExtendToRoundNumbers) {
  const AxisTicks ticks = logarithmic_ticks(0.03, 0.8, 8);
  EXPECT_THAT(ticks.labels, ElementsAre("0.02", "0.05", "0.1", "0.2", "0.5", "1"));
  EXPECT_TRUE(ticks.low == 0.02 && ticks.high == 1);
  EXPECT_THAT(logarithmic_ticks(0.001, 100, 7).labels,
              ElementsAre("0.001", "0.01", "0.1", "1", "10", "100"));
  EXPECT_THAT(logarithmic_ticks(1e-6, 1e6, 8).values, SizeIs(7));
}

TEST(AxisTicks, ExtendARangeOfOneValue) {
  const AxisTicks linear = linear_ticks(30, 30, 5), logarithmic = logarithmic_ticks(1, 1, 5);
  EXPECT_TRUE(linear.low < 30 && linear.high > 30);
  EXPECT_TRUE(logarithmic.low == 1 && logarithmic.high == 2);
}

TEST(AxisTicks, AreAtLeastThree) {
  for (const double low : {0.0, 0.013, 1.0, 9.6, 3700.0})
    for (const double length : {0.003, 0.4, 1.01, 2.9, 30.0, 720.0})
      for (const int most : {1, 2, 3, 8})
        EXPECT_GE(linear_ticks(low, low + length, most).values.size(), 3U) << low << " " << length;
  for (const double low : {0.0012, 0.1, 0.5, 1.0, 7.0})
    for (const double factor : {1.0, 1.05, 1.9, 2.5, 6.0, 40.0, 900.0, 1e7})
      for (const int most : {2, 3, 4, 8}) {
        const AxisTicks ticks = logarithmic_ticks(low, factor * low, most);
        EXPECT_GE(ticks.values.size(), 3U) << low << " x " << factor << ", " << most;
        EXPECT_GE(ticks.values.front(), ticks.low);
        EXPECT_LE(ticks.values.back(), ticks.high);
      }
  EXPECT_THAT(logarithmic_ticks(0.12, 0.18, 4).labels, ElementsAre("0.1", "0.15", "0.2"));
}

cv::Rect covered(const std::string& text, const Eigen::Vector2d& at, const TextFormat& style) {
  const cv::Mat image = drawn_image(
      {1400, 300}, 1, 0xFFFFFF, [&](cairo_t& cairo) { draw_text(cairo, text, at, style); });
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  return cv::boundingRect(gray < 250);
}

TEST(CairoDrawing, TextIsAsWideAsMeasured) {
  for (const bool bold : {false, true})
    for (const char* text : {"Plane normal error", "\u03c3 [\u00b0]", "H"}) {
      const TextFormat style{.size = 100, .anchor = Anchor::begin, .bold = bold};
      const cv::Rect box = covered(text, {100, 150}, style);
      EXPECT_NEAR(box.x, 100, 12) << text;
      EXPECT_NEAR(box.br().x, 100 + width_of(text, 100, bold), 12) << text;
    }
  EXPECT_TRUE(covered(" ", {100, 150}, {100}).empty());
  EXPECT_FALSE(covered("\xFF recording", {700, 150}, {50}).empty()) << "not UTF-8";
}

TEST(CairoDrawing, TextIsAroundItsAnchor) {
  const cv::Rect capital = covered("H", {700, 150}, {100});
  EXPECT_NEAR(capital.y + capital.height / 2.0, 150, 1);
  EXPECT_NEAR(capital.x + capital.width / 2.0, 700, 1);
  EXPECT_NEAR(covered("HHH", {700, 150}, {100, 0, Anchor::end}).br().x, 700, 12);
  const cv::Rect upwards = covered("HHH", {700, 150}, {.size = 50, .upwards = true});
  EXPECT_GT(upwards.height, 2 * upwards.width);
}

TEST(CairoDrawing, WrapsWordsIntoTheRoom) {
  const std::string text = "median and quartiles over the windows that all of them solved";
  const std::vector<std::string> lines = wrapped(text, 10, false, 120);
  EXPECT_GT(lines.size(), 2U);
  for (const std::string& line : lines) EXPECT_LE(width_of(line, 10), 120) << line;
  EXPECT_EQ(fmt::format("{}", fmt::join(lines, " ")), text);
  EXPECT_TRUE(wrapped("", 10, false, 120).empty());
}

TEST(CairoDrawing, StraightLinesAreSharpAnywhere) {
  for (const double y : {4.0, 4.3, 4.5, 4.9}) {
    const cv::Mat image = drawn_image({8, 8}, 1, 0xFFFFFF, [&](cairo_t& cairo) {
      stroke_straight(cairo, {0, y}, {8, y}, {1, {0x000000}});
    });
    EXPECT_EQ(cv::countNonZero(image.reshape(1) == 0), 3 * 8) << y;
    EXPECT_EQ(cv::countNonZero(image.reshape(1) == 255), 3 * 7 * 8) << y;
  }
}

TEST(CairoDrawing, ReportsFailure) {
  EXPECT_THROW(drawn_image({8, 8}, 0, 0, [](cairo_t&) {}), std::runtime_error);
}

}  // namespace
}  // namespace gpo
