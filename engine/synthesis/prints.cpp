// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/drawing.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

const cv::Scalar kPaper(228, 236, 240, 255);
const cv::Scalar kInk(46, 40, 38, 255);

void bar(cv::Mat& canvas, const cv::Rect2d& at, const cv::Scalar& color) {
  part(canvas, at.x, at.y, at.width, at.height).setTo(color);
}

void disc(cv::Mat& canvas, cv::Point at, int radius, const cv::Scalar& color) {
  cv::circle(canvas, at, radius, color, cv::FILLED, cv::LINE_AA);
}

void draw_barcode(cv::Mat& canvas, const cv::Rect2d& at, Random& random) {
  bar(canvas, at, rgb(0xffffff));
  for (double x = at.x + 0.06 * at.width; x < at.x + 0.92 * at.width;) {
    const double thick = at.width * random.uniform(0.015, 0.05);
    bar(canvas, {x, at.y + 0.1 * at.height, thick, 0.7 * at.height}, rgb(0x141414));
    x += thick + at.width * random.uniform(0.015, 0.05);
  }
}

void draw_magazine(cv::Mat& canvas, Random& random) {
  const double h = ratio_of(canvas);
  const int subject = random.below(3);
  const Palette& palette = pick_palette(random);
  if (subject == 0) paint_landscape(canvas, random);
  if (subject == 1) paint_flowers(canvas, random);
  if (subject == 2) paint_shapes(canvas, 70, palette, random);
  const cv::Scalar title = subject == 0 ? rgb(0xffffff) : palette.back();
  bar(canvas, {0, 0, 1, 0.27}, palette.front());
  draw_text(canvas, pick_title(random), {0.06, 0.2}, {0.13, title, Face::serif, 0.88});
  const std::string issue = fmt::format("No. {}   JOURNAL OF PLACES 2026", 10 + random.below(80));
  draw_text(canvas, issue, {0.06, 0.25}, {0.022, title, Face::sans, 0.88});
  bar(canvas, {0.06, 0.62 * h, 0.5, 0.25}, palette[1]);
  const TextStyle headline{0.034, palette.back(), Face::bold, 0.44};
  for (int i = 0; i < 3; ++i)
    draw_text(canvas, pick_words(3, random), {0.09, 0.62 * h + 0.075 + 0.07 * i}, headline);
  draw_barcode(canvas, {0.7, h - 0.2, 0.24, 0.14}, random);
}

void draw_letter(cv::Mat& canvas, Random& random) {
  const double h = ratio_of(canvas);
  const Palette& palette = pick_palette(random);
  canvas.setTo(kPaper);
  const std::string name = pick_title(random) + " INSTITUTE";
  draw_text(canvas, name, {0.1, 0.13}, {0.035, palette[0], Face::serif, 0.6});
  bar(canvas, {0.1, 0.155, 0.8, 0.006}, palette[2]);
  const int w = canvas.cols;
  disc(canvas, {w * 84 / 100, w / 11}, w / 22, palette[2]);
  disc(canvas, {w * 86 / 100, w / 12}, w / 40, palette[1]);
  draw_paragraph(canvas, {0.1, 0.2, 0.8, 0.36 * h - 0.2}, 0.021, kInk, random);
  const double floor = 0.66 * h;
  bar(canvas, {0.1, floor, 0.8, 0.004}, kInk);
  for (int i = 0; i < 9; ++i) {
    const double tall = random.uniform(0.05, 0.24 * h);
    bar(canvas, {0.12 + 0.087 * i, floor - tall, 0.055, tall}, palette[i % 3]);
  }
  draw_paragraph(canvas, {0.1, floor + 0.05, 0.8, h - floor - 0.13}, 0.021, kInk, random);
}

void draw_postcard(cv::Mat& canvas, Random& random) {
  canvas.setTo(rgb(0xf6f3ea));
  const double h = ratio_of(canvas);
  const Palette& palette = pick_palette(random);
  cv::Mat image = part(canvas, 0.04, 0.04, 0.92, h - 0.08);
  paint_mosaic(image, 70, palette, random);
  bar(canvas, {0.3, 0.4 * h, 0.4, 0.13}, palette.back());
  const TextStyle style{0.07, palette.front(), Face::serif, 0.34};
  draw_text(canvas, pick_title(random), {0.33, 0.4 * h + 0.1}, style);
}

void draw_photo(cv::Mat& canvas, Random& random) {
  canvas.setTo(rgb(0xf4f4f2));
  cv::Mat image = part(canvas, 0.035, 0.035, 0.93, ratio_of(canvas) - 0.07);
  if (random.uniform() < 0.5)
    paint_flowers(image, random);
  else
    paint_landscape(image, random);
}

void draw_pip(cv::Mat& canvas, cv::Point2d at, double size, int suit, const cv::Scalar& color) {
  const double s = size * canvas.cols;
  const cv::Point2d c = at * static_cast<double>(canvas.cols);
  const auto leaf = [&](double x, double y, double r) {
    disc(canvas, {cvRound(c.x + x * s), cvRound(c.y + y * s)}, cvRound(r * s), color);
  };
  const auto polygon = [&](const std::vector<cv::Point2d>& shape) {
    std::vector<cv::Point> points;
    for (const auto& p : shape) points.emplace_back(cvRound(c.x + p.x * s), cvRound(c.y + p.y * s));
    cv::fillPoly(canvas, std::vector<std::vector<cv::Point>>{points}, color, cv::LINE_AA);
  };
  if (suit == 0) polygon({{0, -1}, {0.7, 0}, {0, 1}, {-0.7, 0}});
  if (suit == 1 || suit == 2) {  // a spade is a heart upside down with a foot
    const double up = suit == 1 ? 1 : -1;
    leaf(-0.42, -0.35 * up, 0.48);
    leaf(0.42, -0.35 * up, 0.48);
    polygon({{-0.86, -0.15 * up}, {0.86, -0.15 * up}, {0, 0.95 * up}});
  }
  if (suit == 3) {
    leaf(0, -0.45, 0.42);
    leaf(-0.48, 0.15, 0.42);
    leaf(0.48, 0.15, 0.42);
  }
  if (suit >= 2) polygon({{0, 0}, {0.35, 1}, {-0.35, 1}});
}

void draw_card(cv::Mat& canvas, Random& random) {
  const double h = ratio_of(canvas);
  const int radius = canvas.cols / 14;
  canvas.setTo(cv::Scalar(240, 246, 248, 0));
  cv::Mat opacity(canvas.size(), CV_8UC1, cv::Scalar(0));
  cv::rectangle(opacity, {radius, 0}, {canvas.cols - 1 - radius, canvas.rows - 1}, 255, cv::FILLED);
  cv::rectangle(opacity, {0, radius}, {canvas.cols - 1, canvas.rows - 1 - radius}, 255, cv::FILLED);
  for (const int x : {radius, canvas.cols - 1 - radius})
    for (const int y : {radius, canvas.rows - 1 - radius}) disc(opacity, {x, y}, radius, 255);
  const int suit = random.below(4);
  const cv::Scalar color = suit < 2 ? rgb(0xc1121f) : rgb(0x151515);
  static const std::array ranks = {"A", "5", "7", "9", "10"};
  const int rank = random.below(5);
  for (int half = 0; half < 2; ++half) {
    draw_text(canvas, ranks[rank], {0.06, 0.2}, {0.13, color, Face::bold, 0.2});
    draw_pip(canvas, {0.13, 0.3}, 0.06, suit, color);
    if (rank > 0) {
      draw_pip(canvas, {0.32, 0.25 * h}, 0.1, suit, color);
      draw_pip(canvas, {0.68, 0.25 * h}, 0.1, suit, color);
    }
    if (rank > 1) draw_pip(canvas, {0.5, 0.36 * h}, 0.1, suit, color);
    if (rank > 2) draw_pip(canvas, {0.68, 0.42 * h}, 0.1, suit, color);
    cv::rotate(canvas, canvas, cv::ROTATE_180);
  }
  draw_pip(canvas, {0.5, 0.5 * h}, rank == 0 ? 0.22 : 0.1, suit, color);
  cv::insertChannel(opacity, canvas, 3);
}

void draw_map(cv::Mat& canvas, Random& random) {
  const double h = ratio_of(canvas);
  // clang-format off
  const Palette blocks = {rgb(0xffffff), rgb(0xe8dfce), rgb(0xdcd6c5), rgb(0xf0e6d2),
                          rgb(0xc5ddb0), rgb(0xe4d9c9), rgb(0xd9cfc1)};
  // clang-format on
  paint_mosaic(canvas, 190, blocks, random);
  std::vector<cv::Point> river;
  const std::uint64_t seed = random.bits();
  for (int i = -5; i <= 106; ++i) {
    const double t = 0.01 * i;
    river.emplace_back(cvRound(t * canvas.cols),
                       cvRound((0.15 + 0.7 * fractal_noise(t * 2.2, 0, 3, seed)) * canvas.rows));
  }
  cv::polylines(canvas, river, false, rgb(0x8fc1de), canvas.cols / 18, cv::LINE_AA);
  for (int i = 0; i < 5; ++i) {
    const cv::Point a(random.below(canvas.cols), i % 2 == 0 ? 0 : canvas.rows);
    const int y = random.below(canvas.rows);
    const cv::Point b(random.below(2) * canvas.cols, y);
    cv::line(canvas, a, b, rgb(0xc98a2b), canvas.cols / 60, cv::LINE_AA);
    cv::line(canvas, a, b, rgb(0xfbd57e), canvas.cols / 90, cv::LINE_AA);
  }
  for (int i = 0; i < 9; ++i) {
    const double x = random.uniform(0.02, 0.8);
    const double y = random.uniform(0.1, 0.95) * h;
    draw_text(canvas, pick_word(random), {x, y}, {0.022, rgb(0x4b4238), Face::bold});
  }
  for (int i = 0; i < 7; ++i) {
    const int y = random.below(canvas.rows);
    const cv::Point at(random.below(canvas.cols), y);
    disc(canvas, at, canvas.cols / 55, rgb(0xb3202a));
    disc(canvas, at, canvas.cols / 120, rgb(0xffffff));
  }
  bar(canvas, {0.02, 0.02, 0.3, 0.075}, rgb(0x1d3557));
  draw_text(canvas, "CITY MAP", {0.04, 0.075}, {0.036, rgb(0xffffff), Face::bold, 0.26});
}

void draw_mousepad(cv::Mat& canvas, Random& random) {
  const Palette palette = {rgb(0x18222e), rgb(0x243b4a), rgb(0x5fa8a0), rgb(0xe0b45c)};
  paint_contours(canvas, palette, random);
  const TextStyle style{0.04, rgb(0xf2e9d8), Face::bold, 0.28};
  draw_text(canvas, pick_title(random), {0.66, ratio_of(canvas) - 0.06}, style);
}

void draw_notebook(cv::Mat& canvas, Random& random) {
  const double h = ratio_of(canvas);
  const Palette& palette = pick_palette(random);
  canvas.setTo(palette.front());
  add_grain(canvas, 4, random);
  bar(canvas, {0.86, 0, 0.035, h}, palette[2]);
  bar(canvas, {0.16, 0.2 * h, 0.56, 0.3}, palette.back());
  const TextStyle style{0.05, palette.front(), Face::serif, 0.48};
  draw_text(canvas, "Field notes", {0.2, 0.2 * h + 0.1}, style);
  for (int i = 0; i < 3; ++i) bar(canvas, {0.2, 0.2 * h + 0.15 + 0.05 * i, 0.48, 0.005}, kInk);
  draw_text(canvas, pick_words(2, random), {0.22, 0.2 * h + 0.19}, {0.028, kInk});
  cv::Mat sticker = part(canvas, 0.2, 0.62 * h, 0.4, 0.28 * h);
  paint_shapes(sticker, 22, pick_palette(random), random);
}

void draw_rug(cv::Mat& canvas, Random& random) {
  const double h = ratio_of(canvas);
  const Palette& palette = pick_palette(random);
  canvas.setTo(palette.front());
  bar(canvas, {0.03, 0.03, 0.94, h - 0.06}, palette.back());
  bar(canvas, {0.05, 0.05, 0.9, h - 0.1}, palette[1]);
  constexpr int kAcross = 18;
  for (int i = 0; i < kAcross; ++i) {
    const double x = 0.065 + i * 0.88 / kAcross;
    for (const double y : {0.065, h - 0.095})
      bar(canvas, {x, y, 0.03, 0.03}, palette[i % palette.size()]);
  }
  paint_mosaic(part(canvas, 0.12, 0.12, 0.76, h - 0.24), 90, palette, random);
  add_grain(canvas, 7, random);
}

using PrintKind = std::pair<const char*, void (*)(cv::Mat& canvas, Random& random)>;
constexpr std::array<PrintKind, 9> kPrintKinds = {{{"magazine", draw_magazine},
                                                   {"letter", draw_letter},
                                                   {"postcard", draw_postcard},
                                                   {"photo", draw_photo},
                                                   {"card", draw_card},
                                                   {"map", draw_map},
                                                   {"mousepad", draw_mousepad},
                                                   {"notebook", draw_notebook},
                                                   {"rug", draw_rug}}};

}  // namespace

std::vector<std::string> print_kinds() { return keys_of(kPrintKinds); }

cv::Mat draw_print(const std::string& kind, cv::Size size_px, Random random) {
  cv::Mat canvas = blank_canvas(size_px, kPaper);
  for (const auto& [key, draw] : kPrintKinds)
    if (kind == key) draw(canvas, random);
  return canvas;
}

}  // namespace gpo
