// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kSubPixelBits = 4;

cv::Point fixed(const cv::Mat& canvas, cv::Point2d place) {
  const double scale = canvas.cols * (1 << kSubPixelBits);
  return {static_cast<int>(std::lround(place.x * scale)),
          static_cast<int>(std::lround(place.y * scale))};
}

cv::Scalar mixed(const cv::Scalar& a, const cv::Scalar& b, double t) {
  cv::Scalar color = a * (1 - t) + b * t;
  color[3] = 255;
  return color;
}

cv::Vec4b pixel(const cv::Scalar& color) {
  return {cv::saturate_cast<uchar>(color[0]),
          cv::saturate_cast<uchar>(color[1]),
          cv::saturate_cast<uchar>(color[2]),
          255};
}

}  // namespace

void paint_landscape(cv::Mat canvas, Random& random) {
  struct Mood {
    unsigned zenith, horizon, far, near;
  };
  static const std::array<Mood, 4> moods = {{{0x2f6fb0, 0xf6e3c5, 0x8fa9c4, 0x1f3a2d},
                                             {0x3b2a63, 0xf7a072, 0x9a6d8f, 0x1c1430},
                                             {0x5fb0c9, 0xfdf4d8, 0x9cc5a1, 0x24552f},
                                             {0x254a6a, 0xf2c57c, 0xb98b73, 0x40251c}}};
  const Mood& mood = moods[static_cast<std::size_t>(random.below(moods.size()))];
  const std::uint64_t seed = random.bits();
  const double sun_x = random.uniform(0.15, 0.85);
  const double sun_y = random.uniform(0.12, 0.3);
  const double ratio = static_cast<double>(canvas.rows) / canvas.cols;
  constexpr int kRidges = 5;
  std::vector<std::array<double, kRidges>> skyline(static_cast<std::size_t>(canvas.cols));
  for (std::size_t col = 0; col < skyline.size(); ++col) {
    const double u = static_cast<double>(col) / canvas.cols;
    for (int k = 0; k < kRidges; ++k) {
      const double ridge = fractal_noise(u * (2.5 + k), 10.0 * k, 6, seed + 7);
      skyline[col][k] = 0.38 + 0.13 * k - 0.30 * (1 - 0.1 * k) * (ridge - 0.4);
    }
  }
  for (int row = 0; row < canvas.rows; ++row) {
    const double v = static_cast<double>(row) / canvas.rows;
    for (int col = 0; col < canvas.cols; ++col) {
      const double u = static_cast<double>(col) / canvas.cols;
      const double cloud = fractal_noise(u * 4, v * ratio * 12, 5, seed);
      cv::Scalar color = mixed(rgb(mood.zenith), rgb(mood.horizon), std::min(1.0, v * 1.7));
      color = mixed(color, rgb(0xffffff), std::clamp((cloud - 0.52) * 4, 0.0, 0.8));
      const double sun = std::hypot(u - sun_x, (v - sun_y) * ratio);
      if (sun < 0.07) color = rgb(0xfff6d5);
      int nearest = -1;
      for (int k = 0; k < kRidges; ++k) {
        if (v >= skyline[static_cast<std::size_t>(col)][k]) nearest = k;
      }
      if (nearest >= 0) {
        const double tone = fractal_noise(u * 22, v * ratio * 22, 3, seed + 20 + nearest);
        const double contrast = std::clamp(0.5 + 1.6 * (tone - 0.5), 0.0, 1.0);
        color = mixed(rgb(mood.far), rgb(mood.near), nearest / (kRidges - 1.0)) *
                (0.5 + 1.0 * contrast);
      }
      canvas.at<cv::Vec4b>(row, col) = pixel(color);
    }
  }
}

void paint_mosaic(cv::Mat canvas, int cells, const Palette& palette, Random& random) {
  struct Cell {
    double x, y;
    cv::Scalar color;
  };
  const double ratio = static_cast<double>(canvas.rows) / canvas.cols;
  std::vector<Cell> seeds;
  for (int i = 0; i < cells; ++i) {
    const std::size_t color = 1 + random.below(palette.size() - 1);
    seeds.push_back(
        {random.uniform(), random.uniform(0, ratio), palette[color] * random.uniform(0.8, 1.1)});
  }
  const double seam = 0.12 / std::sqrt(static_cast<double>(cells));
  for (int row = 0; row < canvas.rows; ++row) {
    for (int col = 0; col < canvas.cols; ++col) {
      double nearest = 1e9;
      double second = 1e9;
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
      canvas.at<cv::Vec4b>(row, col) = pixel(mixed(palette.front(), owner->color, inside));
    }
  }
}

void paint_shapes(cv::Mat canvas, int shapes, const Palette& palette, Random& random) {
  const double ratio = static_cast<double>(canvas.rows) / canvas.cols;
  canvas.setTo(palette.back());
  for (int i = 0; i < shapes; ++i) {
    const auto& color = palette[static_cast<std::size_t>(random.below(palette.size()))];
    const cv::Point2d center = pick_place(random, ratio);
    const double r = random.uniform(0.03, 0.15);
    const double turn = random.uniform(0, 6.28);
    const int corners = 3 + random.below(3);
    if (random.uniform() < 0.35) {
      cv::circle(canvas,
                 fixed(canvas, center),
                 cvRound(r * canvas.cols * (1 << kSubPixelBits)),
                 color,
                 random.uniform() < 0.4 ? std::max(2, canvas.cols / 60) : cv::FILLED,
                 cv::LINE_AA,
                 kSubPixelBits);
      continue;
    }
    std::vector<cv::Point> polygon;
    for (int k = 0; k < corners; ++k) {
      const double angle = turn + 6.2831853 * k / corners;
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
  for (int row = 0; row < canvas.rows; ++row) {
    for (int col = 0; col < canvas.cols; ++col) {
      const double h = height(col, row);
      const double slope = std::hypot(height(col + 1, row) - h, height(col, row + 1) - h) + 1e-6;
      const double from_line = std::abs(h - std::round(h)) / slope;
      const bool major = std::lround(h) % 4 == 0;
      const double ink = std::clamp((major ? 2.4 : 1.3) - from_line, 0.0, 1.0);
      const double t = std::clamp((h - 4) / 8, 0.0, 1.0);
      const cv::Scalar ground = mixed(palette[0], palette[1], t);
      canvas.at<cv::Vec4b>(row, col) =
          pixel(mixed(ground, palette[palette.size() - (major ? 1 : 2)], ink * 0.85));
    }
  }
}

void paint_flowers(cv::Mat canvas, Random& random) {
  const double ratio = static_cast<double>(canvas.rows) / canvas.cols;
  const Palette& palette = pick_palette(random);
  canvas.setTo(mixed(palette.front(), rgb(0x101010), 0.5));
  const auto petal = [&](cv::Point2d at, double r, double angle, const cv::Scalar& color) {
    const cv::Point2d middle = at + r * cv::Point2d(std::cos(angle), std::sin(angle));
    std::vector<cv::Point> outline;
    for (int k = 0; k < 18; ++k) {
      const double a = 0.35 * k;
      const cv::Point2d p(r * std::cos(a), 0.42 * r * std::sin(a));
      outline.push_back(fixed(canvas,
                              middle + cv::Point2d(p.x * std::cos(angle) - p.y * std::sin(angle),
                                                   p.x * std::sin(angle) + p.y * std::cos(angle))));
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
    const std::size_t which = 1 + random.below(palette.size() - 1);
    const cv::Scalar& color = palette[which];
    for (int k = 0; k < 6; ++k) petal(at, r, k * 1.0472, mixed(color, rgb(0xffffff), 0.08 * k));
    cv::circle(canvas,
               fixed(canvas, at),
               cvRound(0.4 * r * canvas.cols * 16),
               rgb(0xf2c14e),
               cv::FILLED,
               cv::LINE_AA,
               kSubPixelBits);
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
