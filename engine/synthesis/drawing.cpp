// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

int font_of(Face face) {
  switch (face) {
    case Face::bold:
      return cv::FONT_HERSHEY_DUPLEX;
    case Face::serif:
      return cv::FONT_HERSHEY_TRIPLEX;
    default:
      return cv::FONT_HERSHEY_SIMPLEX;
  }
}

}  // namespace

cv::Scalar rgb(unsigned hex) {
  return {static_cast<double>(hex & 255),
          static_cast<double>(hex >> 8 & 255),
          static_cast<double>(hex >> 16 & 255),
          255};
}

double ratio_of(const cv::Mat& canvas) { return static_cast<double>(canvas.rows) / canvas.cols; }

const Palette& pick_palette(Random& random) {
  static const std::array<Palette, 8> palettes = {{
      {rgb(0x264653), rgb(0x2a9d8f), rgb(0xe76f51), rgb(0xf4a261), rgb(0xe9c46a), rgb(0xfaf3dd)},
      {rgb(0x1d3557), rgb(0x457b9d), rgb(0xe63946), rgb(0xa8dadc), rgb(0xf1faee)},
      {rgb(0x2b2d42), rgb(0xd90429), rgb(0xef8354), rgb(0x8d99ae), rgb(0xedf2f4)},
      {rgb(0x5f0f40), rgb(0x9a031e), rgb(0xe36414), rgb(0xfb8b24), rgb(0xfff1d0)},
      {rgb(0x283618), rgb(0x606c38), rgb(0xbc6c25), rgb(0xdda15e), rgb(0xfefae0)},
      {rgb(0x003049), rgb(0x0077b6), rgb(0x00b4d8), rgb(0xf77f00), rgb(0xfcbf49), rgb(0xeae2b7)},
      {rgb(0x231942), rgb(0x5e548e), rgb(0x9f86c0), rgb(0xe0b1cb), rgb(0xf7f0f5)},
      {rgb(0x22223b), rgb(0x4a4e69), rgb(0xc9704f), rgb(0xc9ada7), rgb(0xf2e9e4)},
  }};
  return palettes[static_cast<std::size_t>(random.below(palettes.size()))];
}

cv::Mat blank_canvas(cv::Size size, const cv::Scalar& color) {
  return {std::max(size.height, 4), std::max(size.width, 4), CV_8UC4, color};
}

cv::Mat part(cv::Mat& canvas, double x, double y, double width, double height) {
  const double s = canvas.cols;
  const cv::Rect wanted(cv::Point(cvRound(x * s), cvRound(y * s)),
                        cv::Point(cvRound((x + width) * s), cvRound((y + height) * s)));
  return canvas(wanted & cv::Rect({}, canvas.size()));
}

void draw_text(cv::Mat& canvas,
               const std::string& text,
               cv::Point2d place,
               const TextStyle& style) {
  // Capitals of the Hershey fonts are 21 units high.
  const int font = font_of(style.face);
  double scale = style.height * canvas.cols / 21;
  const double width = cv::getTextSize(text, font, scale, 1, nullptr).width;
  scale *= std::min(1.0, style.max_width * canvas.cols / std::max(width, 1.0));
  const int thickness = std::max(1, cvRound(scale * (style.face == Face::sans ? 1.6 : 2.6)));
  const cv::Point at(cvRound(place.x * canvas.cols), cvRound(place.y * canvas.cols));
  cv::putText(canvas, text, at, font, scale, style.color, thickness, cv::LINE_AA);
}

std::string pick_word(Random& random) {
  static const std::array<const char*, 48> words = {
      "the",     "of",       "camera", "a",      "plane",   "under",  "window", "light",
      "global",  "and",      "to",     "garden", "morning", "motion", "from",   "paper",
      "river",   "is",       "small",  "with",   "stone",   "as",     "winter", "measure",
      "through", "distance", "house",  "by",     "normal",  "wooden", "voyage", "in",
      "summer",  "table",    "for",    "map",    "wind",    "on",     "north",  "people",
      "journal", "between",  "at",     "city",   "every",   "story",  "corner", "bread"};
  return words[static_cast<std::size_t>(random.below(words.size()))];
}

std::string pick_words(int count, Random& random) {
  std::string words = pick_word(random);
  for (int i = 1; i < count; ++i) words.insert(0, pick_word(random) + " ");
  return words;
}

cv::Point2d pick_place(Random& random, double ratio) {
  const double y = random.uniform(0, ratio);
  return {random.uniform(), y};
}

std::string pick_title(Random& random) {
  static const std::array<const char*, 14> titles = {"HORIZON",
                                                     "ATLAS",
                                                     "MERIDIAN",
                                                     "FIELD",
                                                     "NORTH",
                                                     "VOYAGE",
                                                     "LUMEN",
                                                     "PARALLAX",
                                                     "TERRA",
                                                     "COAST",
                                                     "ORBIT",
                                                     "ALPINE",
                                                     "HARBOR",
                                                     "SUMMIT"};
  return titles[static_cast<std::size_t>(random.below(titles.size()))];
}

void draw_paragraph(
    cv::Mat& canvas, cv::Rect2d box, double height, const cv::Scalar& color, Random& random) {
  double y = box.y + height;
  while (y < box.y + box.height) {
    const bool last = random.uniform() < 0.15;
    const double end = box.x + box.width * (last ? random.uniform(0.3, 0.8) : 1.0);
    double x = box.x;
    while (true) {
      const std::string word = pick_word(random);
      const double width =
          cv::getTextSize(word, cv::FONT_HERSHEY_SIMPLEX, height * canvas.cols / 21, 1, nullptr)
              .width /
          static_cast<double>(canvas.cols);
      if (x + width > end) break;
      draw_text(canvas, word, {x, y}, {height, color});
      x += width + 0.55 * height;
    }
    y += (last ? 2.9 : 1.9) * height;
  }
}

}  // namespace gpo
