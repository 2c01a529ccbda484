// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/drawing.h"

#include <cmath>
#include <iterator>
#include <sstream>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr double kUnits = 21;  // height of capitals of the Hershey fonts
constexpr int kSubPixelBits = 4;

int font_of(Face face) {
  return face == Face::bold    ? cv::FONT_HERSHEY_DUPLEX
         : face == Face::serif ? cv::FONT_HERSHEY_TRIPLEX
                               : cv::FONT_HERSHEY_SIMPLEX;
}

cv::Point fixed(const cv::Mat& canvas, cv::Point2d place) {
  const double scale = canvas.cols * (1 << kSubPixelBits);
  return {static_cast<int>(std::lround(place.x * scale)),
          static_cast<int>(std::lround(place.y * scale))};
}

void draw_disc(cv::Mat& canvas, cv::Point2d center, double r, const cv::Scalar& color, int line) {
  const int radius = cvRound(r * canvas.cols * (1 << kSubPixelBits));
  cv::circle(canvas, fixed(canvas, center), radius, color, line, cv::LINE_AA, kSubPixelBits);
}

cv::Scalar mixed(const cv::Scalar& a, const cv::Scalar& b, double t) {
  cv::Scalar color = a * (1 - t) + b * t;
  color[3] = 255;
  return color;
}

std::vector<std::string> words_of(const char* text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

void paint(cv::Mat& canvas, const auto& color) {
  for (int row = 0; row < canvas.rows; ++row)
    for (int col = 0; col < canvas.cols; ++col)
      canvas.at<cv::Vec4b>(row, col) = opaque(color(row, col));
}

cv::Point2d pick_place(Random& random, double ratio) {
  const double y = random.uniform(0, ratio);
  return {random.uniform(), y};
}

}  // namespace

cv::Scalar rgb(unsigned hex) {
  return cv::Scalar(cv::Vec4i(hex & 255, hex >> 8 & 255, hex >> 16 & 255, 255));
}

cv::Vec4b opaque(const cv::Scalar& color) {
  return {cv::saturate_cast<uchar>(color[0]),
          cv::saturate_cast<uchar>(color[1]),
          cv::saturate_cast<uchar>(color[2]),
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
  return random.pick(palettes);
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
  const int font = font_of(style.face);
  double scale = style.height * canvas.cols / kUnits;
  const double width = cv::getTextSize(text, font, scale, 1, nullptr).width;
  scale *= std::min(1.0, style.max_width * canvas.cols / std::max(width, 1.0));
  const int thickness = std::max(1, cvRound(scale * (style.face == Face::sans ? 1.6 : 2.6)));
  const cv::Point at(cvRound(place.x * canvas.cols), cvRound(place.y * canvas.cols));
  cv::putText(canvas, text, at, font, scale, style.color, thickness, cv::LINE_AA);
}

std::string pick_word(Random& random) {
  static const std::vector<std::string> words = words_of(
      "the of camera a plane under window light global and to garden morning motion from paper "
      "river is small with stone as winter measure through distance house by normal wooden voyage "
      "in summer table for map wind on north people journal between at city every story corner "
      "bread");
  return random.pick(words);
}

std::string pick_words(int count, Random& random) {
  std::string words = pick_word(random);
  for (int i = 1; i < count; ++i) words.insert(0, pick_word(random) + " ");
  return words;
}

std::string pick_title(Random& random) {
  static const std::vector<std::string> titles = words_of(
      "HORIZON ATLAS MERIDIAN FIELD NORTH VOYAGE LUMEN PARALLAX TERRA COAST ORBIT ALPINE HARBOR "
      "SUMMIT");
  return random.pick(titles);
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
      const double scale = height * canvas.cols / kUnits;
      const double width =
          double(cv::getTextSize(word, font_of(Face::sans), scale, 1, nullptr).width) / canvas.cols;
      if (x + width > end) break;
      draw_text(canvas, word, {x, y}, {height, color});
      x += width + 0.55 * height;
    }
    y += (last ? 2.9 : 1.9) * height;
  }
}

void paint_landscape(cv::Mat canvas, Random& random) {
  struct Mood {
    unsigned zenith, horizon, far, near;
  };
  static const std::array<Mood, 4> moods = {{{0x2f6fb0, 0xf6e3c5, 0x8fa9c4, 0x1f3a2d},
                                             {0x3b2a63, 0xf7a072, 0x9a6d8f, 0x1c1430},
                                             {0x5fb0c9, 0xfdf4d8, 0x9cc5a1, 0x24552f},
                                             {0x254a6a, 0xf2c57c, 0xb98b73, 0x40251c}}};
  const Mood& mood = random.pick(moods);
  const std::uint64_t seed = random.bits();
  const double sun_x = random.uniform(0.15, 0.85);
  const double sun_y = random.uniform(0.12, 0.3);
  const double ratio = ratio_of(canvas);
  constexpr int kRidges = 5;
  std::vector<std::array<double, kRidges>> skyline(canvas.cols);
  for (int col = 0; col < canvas.cols; ++col) {
    const double u = static_cast<double>(col) / canvas.cols;
    for (int k = 0; k < kRidges; ++k) {
      const double ridge = fractal_noise(u * (2.5 + k), 10.0 * k, 6, seed + 7);
      skyline[col][k] = 0.38 + 0.13 * k - 0.30 * (1 - 0.1 * k) * (ridge - 0.4);
    }
  }
  paint(canvas, [&](int row, int col) {
    const double v = static_cast<double>(row) / canvas.rows;
    const double u = static_cast<double>(col) / canvas.cols;
    int nearest = -1;
    for (int k = 0; k < kRidges; ++k)
      if (v >= skyline[col][k]) nearest = k;
    if (nearest >= 0) {
      const double tone = fractal_noise(u * 22, v * ratio * 22, 3, seed + 20 + nearest);
      const double contrast = std::clamp(0.5 + 1.6 * (tone - 0.5), 0.0, 1.0);
      return cv::Scalar(mixed(rgb(mood.far), rgb(mood.near), nearest / (kRidges - 1.0)) *
                        (0.5 + 1.0 * contrast));
    }
    if (std::hypot(u - sun_x, (v - sun_y) * ratio) < 0.07) return rgb(0xfff6d5);
    const double cloud = fractal_noise(u * 4, v * ratio * 12, 5, seed);
    const cv::Scalar sky = mixed(rgb(mood.zenith), rgb(mood.horizon), std::min(1.0, v * 1.7));
    return mixed(sky, rgb(0xffffff), std::clamp((cloud - 0.52) * 4, 0.0, 0.8));
  });
}

void paint_mosaic(cv::Mat canvas, int cells, const Palette& palette, Random& random) {
  struct Cell {
    double x, y;
    cv::Scalar color;
  };
  const double ratio = ratio_of(canvas);
  std::vector<Cell> seeds;
  for (int i = 0; i < cells; ++i) {
    const std::size_t color = 1 + random.below(palette.size() - 1);
    seeds.push_back(
        {random.uniform(), random.uniform(0, ratio), palette[color] * random.uniform(0.8, 1.1)});
  }
  const double seam = 0.12 / std::sqrt(static_cast<double>(cells));
  paint(canvas, [&](int row, int col) {
    double nearest = 1e9, second = 1e9;
    const Cell* owner = nullptr;
    for (const Cell& cell : seeds) {
      const double dx = (col + 0.5) / canvas.cols - cell.x;
      const double dy = (row + 0.5) / canvas.cols - cell.y;
      const double d = dx * dx + dy * dy;
      if (d < nearest) {
        second = nearest;
        nearest = d;
        owner = &cell;
      } else if (d < second) {
        second = d;
      }
    }
    const double inside =
        std::clamp((std::sqrt(second) - std::sqrt(nearest) - seam) * canvas.cols / 2, 0.0, 1.0);
    return mixed(palette.front(), owner->color, inside);
  });
}

void paint_shapes(cv::Mat canvas, int shapes, const Palette& palette, Random& random) {
  const double ratio = ratio_of(canvas);
  canvas.setTo(palette.back());
  for (int i = 0; i < shapes; ++i) {
    const auto& color = random.pick(palette);
    const cv::Point2d center = pick_place(random, ratio);
    const double r = random.uniform(0.03, 0.15);
    const double phase = random.uniform(0, 6.28);
    const int corners = 3 + random.below(3);
    if (random.uniform() < 0.35) {
      const bool ring = random.uniform() < 0.4;
      draw_disc(canvas, center, r, color, ring ? std::max(2, canvas.cols / 60) : cv::FILLED);
      continue;
    }
    std::vector<cv::Point> polygon;
    for (int k = 0; k < corners; ++k) {
      const double angle = phase + 6.2831853 * k / corners;
      polygon.push_back(fixed(canvas, center + r * cv::Point2d(std::cos(angle), std::sin(angle))));
    }
    cv::fillConvexPoly(canvas, polygon, color, cv::LINE_AA, kSubPixelBits);
  }
}

void paint_contours(cv::Mat canvas, const Palette& palette, Random& random) {
  const std::uint64_t seed = random.bits();
  const auto height = [&](double col, double row) {
    return fractal_noise(3.2 * col / canvas.cols, 3.2 * row / canvas.cols, 4, seed) * 16;
  };
  paint(canvas, [&](int row, int col) {
    const double h = height(col, row);
    const double slope = std::hypot(height(col + 1, row) - h, height(col, row + 1) - h) + 1e-6;
    const double from_line = std::abs(h - std::round(h)) / slope;
    const bool major = std::lround(h) % 4 == 0;
    const double ink = std::clamp((major ? 2.4 : 1.3) - from_line, 0.0, 1.0);
    const cv::Scalar ground = mixed(palette[0], palette[1], std::clamp((h - 4) / 8, 0.0, 1.0));
    return mixed(ground, palette[palette.size() - (major ? 1 : 2)], ink * 0.85);
  });
}

void paint_flowers(cv::Mat canvas, Random& random) {
  const double ratio = ratio_of(canvas);
  const Palette& palette = pick_palette(random);
  canvas.setTo(mixed(palette.front(), rgb(0x101010), 0.5));
  const auto petal = [&](cv::Point2d at, double r, double angle, const cv::Scalar& color) {
    const double c = std::cos(angle), s = std::sin(angle);
    const cv::Point2d middle = at + r * cv::Point2d(c, s);
    std::vector<cv::Point> outline;
    for (int k = 0; k < 18; ++k) {
      const double a = 0.35 * k;
      const cv::Point2d p(r * std::cos(a), 0.42 * r * std::sin(a));
      outline.push_back(fixed(canvas, middle + cv::Point2d(p.x * c - p.y * s, p.x * s + p.y * c)));
    }
    cv::fillConvexPoly(canvas, outline, color, cv::LINE_AA, kSubPixelBits);
  };
  for (int i = 0; i < 260; ++i) {
    const cv::Scalar color = mixed(rgb(0x16351f), rgb(0x86b35a), random.uniform());
    const double angle = random.uniform(0, 6.28);
    const double r = random.uniform(0.02, 0.06);
    const double x = random.uniform();
    petal({x, random.uniform(0, ratio)}, r, angle, color);
  }
  for (int i = 0; i < 26; ++i) {
    const cv::Point2d at = pick_place(random, ratio);
    const double r = random.uniform(0.025, 0.055);
    const cv::Scalar& color = palette[1 + random.below(palette.size() - 1)];
    for (int k = 0; k < 6; ++k) petal(at, r, k * 1.0472, mixed(color, rgb(0xffffff), 0.08 * k));
    draw_disc(canvas, at, 0.4 * r, rgb(0xf2c14e), cv::FILLED);
  }
}

void add_grain(cv::Mat canvas, double sigma, Random& random) {
  for (int row = 0; row < canvas.rows; ++row) {
    for (int col = 0; col < canvas.cols; ++col) {
      auto& p = canvas.at<cv::Vec4b>(row, col);
      const double grain = sigma * random.normal();
      for (int k = 0; k < 3; ++k) p[k] = cv::saturate_cast<uchar>(p[k] + grain);
    }
  }
}

}  // namespace gpo
