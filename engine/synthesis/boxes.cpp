// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/drawing.h"

#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Page edges of a closed book between its two covers.
void draw_pages(cv::Mat& canvas, const cv::Scalar& cover, Random& random) {
  for (int row = 0; row < canvas.rows; ++row) {
    const double tone = random.uniform(0.86, 1.0);
    canvas.row(row).setTo(cv::Scalar(206 * tone, 226 * tone, 234 * tone, 255));
  }
  const int thick = std::max(1, canvas.rows / 9);
  canvas.rowRange(0, thick).setTo(cover);
  canvas.rowRange(canvas.rows - thick, canvas.rows).setTo(cover);
}

void draw_book(BoxFaces& faces, Random& random) {
  const Palette& palette = pick_palette(random);
  const cv::Scalar& cover = palette[random.below(3)];
  const std::string title = pick_title(random);
  for (cv::Mat& side : faces.sides) draw_pages(side, cover, random);
  cv::Mat& spine = faces.sides[0];
  const double h = ratio_of(spine);
  spine.setTo(cover);
  part(spine, 0.05, 0, 0.02, h).setTo(palette.back());
  part(spine, 0.93, 0, 0.02, h).setTo(palette.back());
  draw_text(spine, title, {0.12, 0.75 * h}, {0.5 * h, palette.back(), Face::serif, 0.5});
  const std::string press = pick_word(random) + " press";
  draw_text(spine, press, {0.7, 0.68 * h}, {0.3 * h, palette.back(), Face::sans, 0.2});
  cv::Mat& top = faces.top;
  const double tall = ratio_of(top);
  top.setTo(cover);
  cv::Mat image = part(top, 0.1, 0.34 * tall, 0.8, 0.5 * tall);
  if (random.uniform() < 0.5)
    paint_mosaic(image, 40, palette, random);
  else
    paint_shapes(image, 40, palette, random);
  draw_text(top, title, {0.1, 0.2 * tall}, {0.1, palette.back(), Face::serif, 0.8});
  const TextStyle small{0.04, palette.back(), Face::sans, 0.8};
  draw_text(top, pick_words(3, random), {0.1, 0.28 * tall}, small);
  draw_text(top, "A. " + pick_word(random), {0.1, 0.93 * tall}, {0.04, palette.back()});
}

void draw_carton(BoxFaces& faces, Random& random) {
  const Palette& palette = pick_palette(random);
  const std::string title = pick_title(random);
  for (cv::Mat& side : faces.sides) {
    const double h = ratio_of(side);
    paint_shapes(side, 46, palette, random);
    part(side, 0.1, 0.22 * h, 0.8, 0.3 * h).setTo(palette.front());
    draw_text(side, title, {0.16, 0.42 * h}, {0.14 * h, palette.back(), Face::serif, 0.68});
    const TextStyle small{0.045 * h, palette.back(), Face::sans, 0.68};
    draw_text(side, "fine tea, 20 bags", {0.16, 0.49 * h}, small);
    part(side, 0, 0, 1, 0.06 * h).setTo(palette[1]);
  }
  paint_mosaic(faces.top, 24, palette, random);
  const double h = ratio_of(faces.top);
  part(faces.top, 0.15, 0.35 * h, 0.7, 0.3 * h).setTo(palette.back());
  draw_text(faces.top, title, {0.2, 0.57 * h}, {0.14 * h, palette.front(), Face::serif, 0.6});
}

/// A scrambled puzzle of 3 x 3 x 3 cubes.
void draw_cube(BoxFaces& faces, Random& random) {
  const Palette stickers = {
      rgb(0xb71c1c), rgb(0x1b5e20), rgb(0x0d47a1), rgb(0xf9a825), rgb(0xef6c00), rgb(0xf5f5f5)};
  const auto draw_face = [&](cv::Mat& face) {
    face.setTo(rgb(0x161616));
    const double h = ratio_of(face);
    for (int i = 0; i < 9; ++i) {
      const int row = i / 3;
      part(face, (i % 3 + 0.08) / 3, h * (row + 0.08) / 3, 0.84 / 3, h * 0.84 / 3)
          .setTo(random.pick(stickers));
    }
  };
  for (cv::Mat& side : faces.sides) draw_face(side);
  draw_face(faces.top);
}

void draw_plank(cv::Mat& face, std::uint64_t seed) {
  const double length = std::max(face.cols, face.rows);
  const bool lying = face.cols >= face.rows;
  for (int row = 0; row < face.rows; ++row) {
    for (int col = 0; col < face.cols; ++col) {
      const double along = (lying ? col : row) / length;
      const double across = (lying ? row : col) / length;
      const double bend = fractal_noise(3 * along, 9 * across, 3, seed);
      const double grain = fractal_noise(9 * along, 140 * across, 2, seed + 1);
      const double ring = 0.5 + 0.5 * std::sin(60 * across + 14 * bend);
      face.at<cv::Vec4b>(row, col) =
          opaque(rgb(0xc99a62) * (0.72 + 0.3 * ring * ring + 0.3 * (grain - 0.5)));
    }
  }
}

/// One piece of wood: a board, a leg.
void draw_wooden(BoxFaces& faces, Random& random) {
  for (cv::Mat& side : faces.sides) draw_plank(side, random.bits());
  draw_plank(faces.top, random.bits());
}

/// One row of books, as wide as the canvas.
void draw_books(cv::Mat row, Random& random) {
  row.setTo(rgb(0x2a1e14));
  const double h = ratio_of(row);
  for (double x = 0.005; x < 0.96;) {
    const double width = h * random.uniform(0.1, 0.26);
    const double height = h * random.uniform(0.7, 0.95);
    const Palette& palette = pick_palette(random);
    const cv::Scalar& cover = random.pick(palette);
    cv::Mat spine = part(row, x, h - height, std::min(width, 0.99 - x), height);
    if (!spine.empty() && random.uniform() < 0.93) {
      spine.setTo(cover);
      const double tall = ratio_of(spine);
      part(spine, 0, tall * random.uniform(0.08, 0.2), 1, 0.05 * tall).setTo(palette.back());
      part(spine, 0.2, tall * random.uniform(0.3, 0.5), 0.6, 0.22 * tall).setTo(palette[1]);
      part(spine, 0, tall * random.uniform(0.78, 0.9), 1, 0.03 * tall).setTo(palette.back());
    }
    x += width + 0.003;
  }
}

/// A bookcase, open in front, with boards about 0.28 of its width apart.
void draw_shelf(BoxFaces& faces, Random& random) {
  draw_wooden(faces, random);
  cv::Mat& front = faces.sides[0];
  const double h = ratio_of(front);
  const int rows = std::max(1, static_cast<int>(h / 0.28));
  for (int i = 0; i < rows; ++i) {
    const double top = 0.03 + i * (h - 0.03) / rows;
    draw_books(part(front, 0.03, top, 0.94, (h - 0.03) / rows - 0.03), random);
  }
}

struct BoxKind {
  const char* key;
  void (*draw)(BoxFaces& faces, Random& random);
};
constexpr std::array<BoxKind, 5> kBoxKinds = {{{"book", draw_book},
                                               {"carton", draw_carton},
                                               {"cube", draw_cube},
                                               {"shelf", draw_shelf},
                                               {"wooden", draw_wooden}}};

/// Light that fades downwards to a dark contact line with the desk.
void shade_side(cv::Mat& side) {
  for (int row = 0; row < side.rows; ++row) {
    const double below = static_cast<double>(side.rows - 1 - row) / side.rows;
    const double light = 0.72 + 0.28 * std::min(1.0, std::sqrt(below));
    cv::Mat pixels = side.row(row);
    pixels.convertTo(pixels, -1, light);
  }
}

}  // namespace

std::vector<std::string> box_kinds() { return keys_of(kBoxKinds); }

BoxFaces draw_box(const std::string& kind, cv::Vec3d size_px, Random random) {
  BoxFaces faces;
  for (std::size_t i = 0; i < faces.sides.size(); ++i) {
    const double width = i % 2 == 0 ? size_px[0] : size_px[1];
    faces.sides[i] = blank_canvas({cvRound(width), cvRound(size_px[2])}, rgb(0x808080));
  }
  faces.top = blank_canvas({cvRound(size_px[0]), cvRound(size_px[1])}, rgb(0x808080));
  for (const BoxKind& known : kBoxKinds)
    if (kind == known.key) known.draw(faces, random);
  for (cv::Mat& side : faces.sides) shade_side(side);
  return faces;
}

}  // namespace gpo
