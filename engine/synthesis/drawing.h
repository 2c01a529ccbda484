// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/random.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// What prints and boxes are drawn with. Canvases are CV_8UC4 (blue, green, red, opacity); places
/// and lengths are in units of the canvas' width, so that a drawing looks alike at any resolution.
using Palette = std::vector<cv::Scalar>;

cv::Scalar rgb(unsigned hex);
/// Five or six colors that go together, the darkest first, the lightest last.
const Palette& pick_palette(Random& random);
cv::Mat blank_canvas(cv::Size size, const cv::Scalar& color);
/// Height by width.
double ratio_of(const cv::Mat& canvas);
/// The part of a canvas, sharing its pixels.
cv::Mat part(cv::Mat& canvas, double x, double y, double width, double height);

enum class Face { sans, bold, serif };
struct TextStyle {
  double height;  ///< of capitals
  cv::Scalar color;
  Face face = Face::sans;
  double max_width = 1e9;  ///< it is shrunk to fit into this
};
/// `place` is where the base line begins.
void draw_text(cv::Mat& canvas, const std::string& text, cv::Point2d place, const TextStyle& style);
std::string pick_word(Random& random);
/// The last one is drawn first.
std::string pick_words(int count, Random& random);
/// Anywhere on a canvas of this height by width. Its y is drawn first.
cv::Point2d pick_place(Random& random, double ratio);
std::string pick_title(Random& random);
/// A column of lines of words, until `box` is full.
void draw_paragraph(
    cv::Mat& canvas, cv::Rect2d box, double height, const cv::Scalar& color, Random& random);

/// A landscape: sky, sun, ridges, woods.
void paint_landscape(cv::Mat canvas, Random& random);
/// Stained glass: `cells` cells of a palette's colors with dark seams.
void paint_mosaic(cv::Mat canvas, int cells, const Palette& palette, Random& random);
/// Discs, bars and triangles in a palette's colors.
void paint_shapes(cv::Mat canvas, int shapes, const Palette& palette, Random& random);
/// Lines of equal height of a hilly country.
void paint_contours(cv::Mat canvas, const Palette& palette, Random& random);
/// Leaves and flowers over dark ground.
void paint_flowers(cv::Mat canvas, Random& random);
/// Slight grain of paper or print, standard deviation in gray levels.
void add_grain(cv::Mat canvas, double sigma, Random& random);

/// magazine, letter, postcard, photo, card, map, mousepad, notebook, rug.
std::vector<std::string> print_kinds();

/// A printed sheet of the named kind as CV_8UC4 (blue, green, red, opacity).
cv::Mat draw_print(const std::string& kind, cv::Size size_px, Random random);

/// book, carton, cube, shelf, wooden.
std::vector<std::string> box_kinds();

/// Faces of a box, CV_8UC4, seen from outside with the box' top at the picture's top: front (-y),
/// right (+x), back (+y), left (-x), and the top as seen from above with +y at the picture's top.
struct BoxFaces {
  std::array<cv::Mat, 4> sides;
  cv::Mat top;
};
BoxFaces draw_box(const std::string& kind, cv::Vec3d size_px, Random random);

/// The face of a desk, a floor or a wall: a rectangle with its center at the origin, x right, y up
/// in its texture. A scale of 2 makes all that is painted on it twice as large and as coarse.
struct PaintedFace {
  Eigen::Vector2d size;  ///< [m]
  double scale = 1;
};

constexpr double kFaceTexelsPerMeter = 1600;   ///< of faces, at scale 1
constexpr double kSheetTexelsPerMeter = 2600;  ///< of prints and boxes, at scale 1

/// Place of a texel's center on the face [m].
Eigen::Vector2d texel_place(const PaintedFace& face, double col, double row, double per_meter);
cv::Mat empty_map(const PaintedFace& face, double per_meter, int type);

/// wood, parquet, plaster, bricks.
std::vector<std::string> surface_kinds();

/// CV_8UC3, +y at the picture's top, without light.
cv::Mat paint_face(const PaintedFace& face,
                   const std::string& kind,
                   std::uint64_t seed,
                   int threads);

/// A sheet on a face; `image` is CV_8UC4 and seen with +y of the sheet at the picture's top.
struct Sheet {
  Eigen::Vector2d center;
  Eigen::Vector2d size;
  Eigen::Matrix2d turn;  ///< from the face into the sheet's axes
  cv::Mat image;
};
void lay_sheet(cv::Mat& texture, const PaintedFace& face, const Sheet& sheet, int threads);

}  // namespace gpo
