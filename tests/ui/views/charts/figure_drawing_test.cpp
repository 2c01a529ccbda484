// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/gl_test.h"
#include "ui/look/look.h"
#include "ui/views/charts/charts.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <tinyxml2.h>

namespace gpo {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kGreen = 0x009E73, kVermilion = 0xD55E00, kYellow = 0xF0E442,
                        kBand = 0xD1ECE3;
const cv::Size kSmall(500, 480);

void add(Curve& curve, double x, double y, const std::vector<double>& band) {
  curve.x.push_back(x);
  curve.y.push_back(y);
  if (band.empty()) return;
  curve.lower.push_back(band[0] * y);
  curve.upper.push_back(band[1] * y);
}

Curve falling(const std::string& name, std::uint32_t rgb, double level, bool band = true) {
  Curve curve{.name = name, .rgb = rgb};
  for (int length = 5; length <= 60; length += 5) {
    const double median = level * (1 + 20.0 / length) * (1 + 0.1 * std::sin(length + level));
    add(curve, length, median, band ? std::vector{0.7, 1.4} : std::vector<double>());
  }
  return curve;
}

Figure paper_figure() {
  Figure figure{"window-length", "desk: median and quartiles over 12 windows", {}};
  // clang-format off
  const std::vector<std::pair<std::string, std::uint32_t>> methods = {
      {"GPO", kGreen}, {"PnP", 0xE69F00}, {"DBSCAN", kYellow}, {"BA", kVermilion},
      {"PnP + BA", 0xCC79A7}, {"PBA", 0x8B5A2B}, {"FPBA", 0x999999}, {"closed form", 0x56B4E9},
      {"GPO joint", 0x0072B2}};
  // clang-format on
  for (const std::string title : {"ATE", "PNE", "PDE"}) {
    const bool angle = title == "PNE";
    const std::string unit = angle ? " [°]" : " [mm]";
    figure.charts.push_back({title, "window length [frames]", title + unit, true, {}});
    Chart& chart = figure.charts.back();
    double level = angle ? 0.05 : 1.3;
    for (const auto& [name, rgb] : methods)
      chart.curves.push_back(falling(name, rgb, level *= 1.5));
    if (!angle) continue;
    chart.curves.push_back(falling("bound (Cramér-Rao)", 0x333333, 0.01, false));
    chart.curves.back().dotted = true;
  }
  return figure;
}

/// Returns one linear chart with axes from (0, 0).
Figure small_figure(const std::vector<double>& y, bool band = false, bool dotted = false) {
  Curve curve{.name = "GPO", .rgb = kGreen, .dotted = dotted};
  const std::vector<double> quartiles = band ? std::vector{0.5, 1.5} : std::vector<double>();
  for (const double value : y) add(curve, static_cast<double>(curve.x.size()), value, quartiles);
  return {"small", "", {{"chart", "x [-]", "y [-]", false, {curve}}}};
}

/// Counts pixels of nearly a color: thin curves are anti-aliased.
int colored(const cv::Mat& image, std::uint32_t rgb) { return count_pixels(image, rgb, 12); }

/// Returns the area within the axes of a figure with one chart.
cv::Mat plot_of(const Figure& figure, const std::string& name) {
  const cv::Mat image = draw_figure(figure, kSmall);
  keep(name, image);
  return image(cv::Rect(93, 48, image.cols - 93 - 20, image.rows - 48 - 100));
}

/// Returns the `index`-th of `count` equal parts of the plot, from the left.
cv::Mat part_of(const cv::Mat& plot, int index, int count) {
  return plot.colRange(index * plot.cols / count, (index + 1) * plot.cols / count);
}

TEST(FigureView, DrawsEveryMethodInItsColor) {
  const Figure figure = paper_figure();
  const cv::Mat image = draw_figure(figure, {1500, 480});
  keep("figure", image);
  ASSERT_EQ(image.size(), cv::Size(1500, 480));
  EXPECT_EQ(image.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 255, 255));
  for (int chart = 0; chart < 3; ++chart)
    for (const CurveStyle& style : curve_styles(figure)) {
      const cv::Mat column = image(cv::Rect(500 * chart, 40, 500, 340));
      if (style.name.starts_with("bound") && chart != 1) continue;
      EXPECT_GT(colored(column, style.rgb), 30) << style.name << " in chart " << chart;
    }
}

TEST(FigureView, SameFigureGivesTheSameBytes) {
  const Figure figure = paper_figure();
  EXPECT_TRUE(same_bytes(draw_figure(figure, {900, 400}), draw_figure(figure, {900, 400})));
  const FigureSheet sheet = screen_sheet(figure, {900, 400});
  EXPECT_EQ(figure_svg(figure, sheet), figure_svg(figure, sheet));
  EXPECT_EQ(figure_pdf(figure, sheet), figure_pdf(figure, sheet));
}

TEST(FigureView, BandIsBetweenTheQuartiles) {
  const cv::Mat plot = plot_of(small_figure({2, 2, 2, 2, 2}, true), "figure_band");
  // The axis is from 0 to 3.15. The column is between points and grid lines.
  const auto tinted_at = [&](double y) {
    const int row = static_cast<int>(std::lround(plot.rows * (1 - y / 3.15)));
    const auto& bgr = plot.at<cv::Vec3b>(std::clamp(row, 0, plot.rows - 1), plot.cols / 2 + 18);
    return bgr[1] > bgr[2] + 20;
  };
  EXPECT_TRUE(tinted_at(1.3) && tinted_at(2.7));
  EXPECT_FALSE(tinted_at(0.7) || tinted_at(3.12));
}

TEST(FigureView, NanLeavesAGapButNotSinglePoints) {
  const cv::Mat gap =
      plot_of(small_figure({1, 1, 1, 1, NAN, NAN, NAN, 1, 1, 1, 1}, true), "figure_gap");
  EXPECT_GT(colored(part_of(gap, 1, 11), kGreen), 20);
  EXPECT_EQ(colored(part_of(gap, 5, 11), kGreen), 0);
  EXPECT_EQ(colored(part_of(gap, 5, 11), kBand), 0) << "the band goes through the gap";
  EXPECT_GT(colored(part_of(gap, 9, 11), kGreen), 20);
  const cv::Mat points = plot_of(small_figure({1, NAN, 1, NAN, 1}, true), "figure_points");
  EXPECT_GT(colored(part_of(points, 2, 5), kGreen), 20);
}

TEST(FigureView, BoundIsDotted) {
  const cv::Mat solid = plot_of(small_figure({1, 1, 1, 1}), "figure_solid");
  const cv::Mat bound = plot_of(small_figure({1, 1, 1, 1}, false, true), "figure_bound");
  EXPECT_GT(colored(bound, kGreen), 30);
  EXPECT_LT(colored(bound, kGreen), colored(solid, kGreen) / 2);
}

TEST(FigureView, LogarithmicAxisLeavesOutValuesThatAreNotPositive) {
  Figure figure = small_figure({1, 0, -1, 10, 100});
  figure.charts[0].logarithmic = true;
  EXPECT_GT(colored(plot_of(figure, "figure_logarithmic"), kGreen), 30);
}

TEST(FigureView, EmptyFiguresHaveAText) {
  Figure nothing{"none", "a title", {}};
  keep("figure_none", draw_figure(nothing, kSmall));
  const Figure no_values = small_figure({NAN, NAN});
  const cv::Mat middle = plot_of(no_values, "figure_no_values")(cv::Rect(100, 100, 180, 130));
  EXPECT_GT(colored(middle, palette::kPaperAxis), 20);
  figure_svg(nothing, screen_sheet(nothing, kSmall));
  figure_pdf(no_values, screen_sheet(no_values, kSmall));
}

TEST(FigureView, SvgNamesItsContent) {
  const Figure figure = paper_figure();
  const std::string svg = figure_svg(figure, screen_sheet(figure, {1500, 480}));
  std::ofstream(GPO_TEST_OUTPUT_DIR "/figure.svg") << svg;
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* root = document.RootElement();
  EXPECT_STREQ(root->Name(), "svg");
  EXPECT_THAT(root->FirstChildElement("title")->GetText(), HasSubstr(figure.title));
  const std::string text = root->FirstChildElement("desc")->GetText();
  for (const Chart& chart : figure.charts) {
    EXPECT_THAT(text, HasSubstr(chart.title));
    EXPECT_THAT(text, HasSubstr(chart.y_label));
    for (const Curve& curve : chart.curves) EXPECT_THAT(text, HasSubstr(curve.name));
  }
  // In points: 1500 x 480 pixels of 96 dpi.
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 1125 360\""));
}

/// Counts the uses of a style in an SVG, in the spelling of any version of Cairo.
int styles_of(std::string svg, const std::string& style) {
  std::erase_if(svg, [](char c) { return c == ' ' || c == '"' || c == ';'; });
  std::ranges::replace(svg, '=', ':');
  int found = -1;
  for (std::size_t at = 0; at != std::string::npos; at = svg.find(style, at + 1)) ++found;
  return found;
}

TEST(FigureView, PrintedTextHasSevenPointsAndStaysOnThePage) {
  Figure figure = paper_figure();
  figure.note =
      "Dotted: a bound that takes more than one line to explain, even on a wide page, "
      "and of which this is the explanation";
  for (const double width_mm : {85.0, 175.0}) {
    const FigureSheet sheet = printed_sheet(figure, width_mm);
    EXPECT_NEAR(sheet.width * sheet.unit_mm, width_mm, 1e-9);
    const FigureType& type = sheet.type;
    for (const double size :
         {type.title, type.chart_title, type.axis_title, type.tick, type.legend, type.note})
      EXPECT_GE(size * sheet.unit_mm / 25.4 * 72, 7 - 1e-9);
    const std::string name = width_mm < 100 ? "figure_85mm" : "figure_175mm";
    cv::Mat image = figure_image(figure, sheet, sheet.unit_mm / 25.4 * 300);
    keep(name, image);
    std::ofstream(GPO_TEST_OUTPUT_DIR "/" + name + ".pdf") << figure_pdf(figure, sheet);
    image(cv::Rect(2, 2, image.cols - 4, image.rows - 4)).setTo(cv::Scalar::all(255));
    EXPECT_EQ(cv::countNonZero(image.reshape(1) != 255), 0) << "cut off at " << width_mm;
  }
}

TEST(FigureView, PdfHasTheFiguresSizeAndItsFonts) {
  const Figure figure = paper_figure();
  const std::string pdf = figure_pdf(figure, printed_sheet(figure, 175));
  EXPECT_THAT(pdf, ::testing::StartsWith("%PDF-1.4\n"));
  EXPECT_THAT(pdf, ::testing::EndsWith("%%EOF\n"));
  // Embedded fonts: text can be selected.
  for (const char* part : {"/MediaBox [ 0 0 496.06", "+Inter-Regular", "+Inter-SemiBold"})
    EXPECT_THAT(pdf, HasSubstr(part));
}

TEST(FigureView, PointsOfFewWindowsAreHollowAndHaveNoBand) {
  Figure figure = small_figure({1, 1, 1, 1, 1}, true);
  const auto svg_of = [&] { return figure_svg(figure, screen_sheet(figure, kSmall)); };
  const auto keys_of = [&] {
    const std::vector<CurveStyle> styles = curve_styles(figure);
    return lay_out(figure, styles, screen_sheet(figure, kSmall)).keys;
  };
  const std::string white = "fill:rgb(100%,100%,100%)";
  figure.charts[0].curves[0].counts = {9, 9, 4, 4, 4};
  const int sheets = styles_of(svg_of(), white);
  EXPECT_EQ(keys_of().back().text, "GPO");
  figure.charts[0].curves[0].counts = {9, 9, 4, 3, 1};
  // Two on the curve, one in the legend.
  EXPECT_EQ(styles_of(svg_of(), white), sheets + 3);
  EXPECT_EQ(keys_of().back().text, "fewer than 4 windows");
  const cv::Mat plot = plot_of(figure, "figure_few");
  EXPECT_GT(colored(part_of(plot, 0, 2), kBand), 1000);
  EXPECT_LT(colored(plot.colRange(plot.cols / 2 + 5, plot.cols), kBand), 50)
      << "only edges of lines";
}

TEST(FigureView, LegendNamesOnlyWhatIsDrawn) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Figure figure = small_figure({1, 2, 3});
  Curve unknown = figure.charts[0].curves[0], zero = unknown;
  unknown.name = "unknown";
  unknown.y = {kNan, kNan, kNan};
  unknown.counts = {1, 1, 1};
  zero.name = "zero";
  zero.y = {0, 0, 0};
  figure.charts[0].curves.push_back(unknown);
  figure.charts[0].curves.push_back(zero);
  const auto texts_of = [&] {
    const std::vector<CurveStyle> styles = curve_styles(figure);
    std::vector<std::string> texts;
    for (const LegendKey& key : lay_out(figure, styles, screen_sheet(figure, kSmall)).keys)
      texts.push_back(key.text);
    return texts;
  };
  EXPECT_EQ(texts_of(), (std::vector<std::string>{"GPO", "zero"}));
  figure.charts[0].logarithmic = true;
  EXPECT_EQ(texts_of(), std::vector<std::string>{"GPO"}) << "a logarithmic axis has no zero";
  figure.charts.push_back(figure.charts[0]);
  figure.charts[1].logarithmic = false;
  EXPECT_EQ(texts_of(), (std::vector<std::string>{"GPO", "zero"})) << "it is in the second chart";
}

TEST(FigureView, ManyBandsAreOutlined) {
  const auto outlines = [](std::size_t curves) {
    Figure figure = paper_figure();
    for (Chart& chart : figure.charts) chart.curves.resize(curves);
    return styles_of(figure_svg(figure, screen_sheet(figure, {1500, 480})), "stroke-opacity:0.6");
  };
  EXPECT_EQ(outlines(3), 0);
  EXPECT_EQ(outlines(6), 3 * 6 * 2);
}

TEST(CurveStyles, DifferInDashesAndColorsWithinOneMethod) {
  Figure figure{"", "", {{"", "", "", false, {}}}};
  // The mixed colors of GPO, anchored, with a gyroscope, consistent and without RANSAC.
  for (const std::uint32_t rgb : {0x009E73, 0x39A793, 0x0E7940, 0x7F9A3E, 0x9C4558})
    figure.charts[0].curves.push_back(
        {.name = std::to_string(rgb), .rgb = rgb, .x = {1}, .y = {1}, .marker = 0});
  const std::vector<CurveStyle> styles = curve_styles(figure);
  EXPECT_EQ(styles[0].rgb, 0x009E73U);
  for (std::size_t i = 0; i < styles.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_NE(styles[i].dashes, styles[k].dashes);
      EXPECT_GT(color_difference(styles[i].rgb, styles[k].rgb), 20) << i << " " << k;
    }
  EXPECT_NEAR(color_difference(0x000000, 0xFFFFFF), 100, 0.1);
}

TEST(CurveStyles, DifferWithoutTheirColors) {
  std::set<std::tuple<bool, std::optional<int>, std::vector<double>>> seen;
  for (const CurveStyle& style : curve_styles(paper_figure()))
    EXPECT_TRUE(seen.emplace(style.dotted, style.marker, style.dashes).second) << style.name;
  EXPECT_EQ(seen.size(), 10U) << "nine methods and the bound";
}

}  // namespace
}  // namespace gpo
