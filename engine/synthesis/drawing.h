// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/random.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

// Canvases are CV_8UC4 (blue, green, red, opacity). Places and lengths are in units of the canvas'
// width, so that a drawing looks alike at any resolution.

using Palette = std::vector<cv::Scalar>;

cv::Scalar rgb(unsigned hex);
cv::Vec4b opaque(const cv::Scalar& color);
/// Five or six matching colors, from dark to light.
const Palette& pick_palette(Random& random);
cv::Mat blank_canvas(cv::Size size, const cv::Scalar& color);
/// Height divided by width.
double ratio_of(const cv::Mat& canvas);
/// Bilinear interpolation of pixels, clamped to the edges.
template <typename Float, typename Pixel>
Float bilinear(const cv::Mat& pixels, double col, double row) {
  const double x = std::clamp(col, 0.0, pixels.cols - 1.001);
  const double y = std::clamp(row, 0.0, pixels.rows - 1.001);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const auto a = static_cast<float>(x - x0);
  const auto b = static_cast<float>(y - y0);
  const auto* top = pixels.ptr<Pixel>(y0) + x0;
  const auto* bottom = pixels.ptr<Pixel>(y0 + 1) + x0;
  return (Float(top[0]) * (1 - a) + Float(top[1]) * a) * (1 - b) +
         (Float(bottom[0]) * (1 - a) + Float(bottom[1]) * a) * b;
}
/// A region of the canvas, which shares its pixels.
cv::Mat part(cv::Mat& canvas, double x, double y, double width, double height);

enum class Face { sans, bold, serif };
struct TextStyle {
  double height;  ///< height of capitals
  cv::Scalar color;
  Face face = Face::sans;
  double max_width = 1e9;  ///< wider text is shrunk
};
/// `place`: left end of the baseline.
void draw_text(cv::Mat& canvas, const std::string& text, cv::Point2d place, const TextStyle& style);
std::string pick_word(Random& random);
std::string pick_words(int count, Random& random);
std::string pick_title(Random& random);
/// Fills `box` with lines of words.
void draw_paragraph(
    cv::Mat& canvas, cv::Rect2d box, double height, const cv::Scalar& color, Random& random);

/// A landscape: sky, sun, ridges, woods.
void paint_landscape(cv::Mat canvas, Random& random);
/// Stained glass with dark seams.
void paint_mosaic(cv::Mat canvas, int cells, const Palette& palette, Random& random);
/// Discs and polygons.
void paint_shapes(cv::Mat canvas, int shapes, const Palette& palette, Random& random);
/// Contour lines of hills.
void paint_contours(cv::Mat canvas, const Palette& palette, Random& random);
/// Leaves and flowers over dark ground.
void paint_flowers(cv::Mat canvas, Random& random);
/// Grain of paper or print, standard deviation in gray levels.
void add_grain(cv::Mat canvas, double sigma, Random& random);

std::vector<std::string> keys_of(const auto& kinds) {
  std::vector<std::string> keys;
  for (const auto& [key, draw] : kinds) keys.emplace_back(key);
  return keys;
}

/// magazine, letter, postcard, photo, card, map, mousepad, notebook, rug.
std::vector<std::string> print_kinds();

/// A printed sheet of the named kind as CV_8UC4 (blue, green, red, opacity).
cv::Mat draw_print(const std::string& kind, cv::Size size_px, Random random);

/// book, carton, cube, shelf, wooden.
std::vector<std::string> box_kinds();

/// Faces of a box, CV_8UC4: front (-y), right (+x), back (+y), left (-x) from outside, and the top
/// from above with +y up.
struct BoxFaces {
  std::array<cv::Mat, 4> sides;
  cv::Mat top;
};
BoxFaces draw_box(const std::string& kind, cv::Vec3d size_px, Random random);

/// Rectangle of a desk, a floor or a wall, with its center at the origin, x right, y up in its
/// texture. A scale of 2 makes everything on it twice as large and as coarse.
struct PaintedFace {
  Eigen::Vector2d size;  ///< [m]
  double scale = 1;
};

constexpr double kFaceTexelsPerMeter = 1600;   ///< for faces at scale 1
constexpr double kSheetTexelsPerMeter = 2600;  ///< for prints and boxes at scale 1

/// Center of a texel on the face [m].
Eigen::Vector2d texel_place(const PaintedFace& face, double col, double row, double per_meter);
cv::Mat empty_map(const PaintedFace& face, double per_meter, int type);

/// wood, parquet, plaster, bricks.
std::vector<std::string> surface_kinds();

/// CV_8UC3, +y up, without light.
cv::Mat paint_face(const PaintedFace& face,
                   const std::string& kind,
                   std::uint64_t seed,
                   int threads);

struct Sheet {
  Eigen::Vector2d center;
  Eigen::Vector2d size;
  Eigen::Matrix2d R_sheet_face;
  cv::Mat image;  ///< CV_8UC4, +y of the sheet up
};
void lay_sheet(cv::Mat& texture, const PaintedFace& face, const Sheet& sheet, int threads);

}  // namespace gpo
