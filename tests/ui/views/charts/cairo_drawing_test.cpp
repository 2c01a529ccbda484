// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/cairo_drawing.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Returns the rectangle that a text covers [px].
cv::Rect covered(const std::string& text, const Eigen::Vector2d& at, const TextStyle& style) {
  const cv::Mat image = drawn_image(
      {1400, 300}, 1, 0xFFFFFF, [&](cairo_t& cairo) { draw_text(cairo, text, at, style); });
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  return cv::boundingRect(gray < 250);
}

TEST(CairoDrawing, TextIsAsWideAsMeasured) {
  for (const bool bold : {false, true})
    for (const char* text : {"Plane normal error", "\u03c3 [\u00b0]", "H"}) {
      const TextStyle style{.size = 100, .anchor = Anchor::begin, .bold = bold};
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
  std::string again;
  for (const std::string& line : lines) {
    EXPECT_LE(width_of(line, 10), 120) << line;
    again += (again.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(again, text);
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
