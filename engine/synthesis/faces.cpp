// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/base/parallel.h"
#include "engine/synthesis/drawing.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

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

void draw_wooden(BoxFaces& faces, Random& random) {
  for (cv::Mat& side : faces.sides) draw_plank(side, random.bits());
  draw_plank(faces.top, random.bits());
}

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

using BoxKind = std::pair<const char*, void (*)(BoxFaces& faces, Random& random)>;
constexpr std::array<BoxKind, 5> kBoxKinds = {{{"book", draw_book},
                                               {"carton", draw_carton},
                                               {"cube", draw_cube},
                                               {"shelf", draw_shelf},
                                               {"wooden", draw_wooden}}};

void shade_side(cv::Mat& side) {
  for (int row = 0; row < side.rows; ++row) {
    const double below = static_cast<double>(side.rows - 1 - row) / side.rows;
    const double light = 0.72 + 0.28 * std::min(1.0, std::sqrt(below));
    cv::Mat pixels = side.row(row);
    pixels.convertTo(pixels, -1, light);
  }
}

cv::Vec3f wood(double x, double y, std::uint64_t seed) {
  constexpr double kPlank = 0.21;
  const double plank = std::floor(y / kPlank);
  const double in_plank = y / kPlank - plank;
  const auto board_seed = seed + static_cast<std::uint64_t>(std::int64_t(plank) + 1000);
  const double shift = 7.3 * plank;
  const double bend = fractal_noise(x * 1.6 + shift, y * 5, 3, board_seed);
  const double rings =
      0.5 + 0.5 * std::sin(2 * std::numbers::pi * (y * 22 + 3.2 * bend + 0.3 * plank));
  const double grain = fractal_noise(x * 5 + shift, y * 90, 2, board_seed + 1);
  const double pore = fractal_noise(x * 22, y * 400, 1, board_seed + 3);
  const double pores = pore * pore * pore * pore;
  const double tone = fractal_noise(0.5, plank * 3.7, 1, seed);
  const double t = 0.34 * rings * rings + 0.34 * (grain - 0.5) + 0.35 * (tone - 0.5);
  cv::Vec3f color = cv::Vec3f(112, 160, 200) * (1 - t) + cv::Vec3f(66, 108, 152) * t;
  color *= 1 - 0.25F * static_cast<float>(pores);
  const double joint = std::min(in_plank, 1 - in_plank) * kPlank;
  return color * static_cast<float>(1 - 0.45 * std::exp(-joint * joint / (2 * 0.0008 * 0.0008)));
}

double lot(double row, double column, std::uint64_t seed) {
  const auto stream = static_cast<std::uint64_t>(static_cast<std::int64_t>(row) * 4096 +
                                                 static_cast<std::int64_t>(column) + (1 << 24));
  return Random(seed, stream).uniform();
}

struct Laid {
  double row;
  double tone;  ///< random, 0 .. 1
  double edge;  ///< distance to its nearest edge [m]
};
struct Courses {
  double length, height;  ///< size of a brick [m]
  double shift;           ///< between successive rows [lengths]
};
Laid laid(double x, double y, const Courses& courses, std::uint64_t seed) {
  const auto& [length, height, shift] = courses;
  const double row = std::floor(y / height);
  const double along = x / length + shift * row;
  const double column = std::floor(along);
  const double in_row = y / height - row;
  const double in_column = along - column;
  return {
      row,
      lot(row, column, seed),
      std::min(std::min(in_row, 1 - in_row) * height, std::min(in_column, 1 - in_column) * length)};
}

float soft_line(double distance, double width) {
  return static_cast<float>(std::exp(-distance * distance / (2 * width * width)));
}

cv::Vec3f parquet(double x, double y, std::uint64_t seed) {
  const Laid stave = laid(x, y, {0.26, 0.036, 0.381966}, seed);
  const double bend = fractal_noise(x * 6 + 17 * stave.tone, y * 24 + 5 * stave.row, 2, seed + 1);
  const double grain = fractal_noise(x * 9 + 9 * stave.tone, y * 160, 2, seed + 2);
  const double t = 0.62 * stave.tone + 0.3 * (grain - 0.5) + 0.4 * (bend - 0.5) + 0.1;
  const cv::Vec3f color = cv::Vec3f(118, 166, 206) * (1 - t) + cv::Vec3f(58, 96, 138) * t;
  return color * (1 - 0.5F * soft_line(stave.edge, 0.0009));
}

cv::Vec3f plaster(double x, double y, std::uint64_t seed) {
  const double stain = fractal_noise(x * 4, y * 4, 4, seed);
  const double rough = fractal_noise(x * 60, y * 60, 3, seed + 1);
  const double t = 0.16 * (stain - 0.5) + 0.22 * (rough - 0.5);
  return cv::Vec3f(176, 196, 204) * (1 + t);
}

cv::Vec3f bricks(double x, double y, std::uint64_t seed) {
  const Laid brick = laid(x, y, {0.075, 0.025, 0.5}, seed);
  const double rough = fractal_noise(x * 70, y * 70, 3, seed + 1);
  const double soot = fractal_noise(x * 9 + 30 * brick.tone, y * 9, 3, seed + 2);
  const double light = 0.62 + 0.5 * brick.tone + 0.5 * (rough - 0.5) + 0.5 * (soot - 0.5);
  const cv::Vec3f clay = cv::Vec3f(74, 92, 156) * light;
  const cv::Vec3f mortar = cv::Vec3f(158, 172, 180) * (0.85 + 0.3 * rough);
  const double wavy = brick.edge + 0.001 * (soot - 0.5);
  const auto t = static_cast<float>(std::clamp((wavy - 0.0011) / 0.0008, 0.0, 1.0));
  return mortar * (1 - t) + clay * t;
}

/// A key with the color at a place in meters at scale 1.
using SurfaceKind = std::pair<const char*, cv::Vec3f (*)(double x, double y, std::uint64_t seed)>;
constexpr std::array<SurfaceKind, 4> kSurfaceKinds = {
    {{"wood", wood}, {"parquet", parquet}, {"plaster", plaster}, {"bricks", bricks}}};

cv::Vec3f cover(const cv::Vec3f& under,
                const Sheet& sheet,
                const Eigen::Vector2d& place,
                double scale) {
  const Eigen::Vector2d in_sheet = sheet.R_sheet_face * (place - sheet.center);
  const Eigen::Array2d outside = in_sheet.array().abs() - sheet.size.array() / 2;
  const double distance = outside.max(0).matrix().norm() / scale;
  const float dark = distance > 0.006 ? 1.0F : static_cast<float>(0.72 + 0.28 * distance / 0.006);
  if (outside.maxCoeff() > 0) return under * dark;
  const double col = (in_sheet.x() / sheet.size.x() + 0.5) * sheet.image.cols - 0.5;
  const double row = (0.5 - in_sheet.y() / sheet.size.y()) * sheet.image.rows - 0.5;
  const cv::Vec4f ink = bilinear<cv::Vec4f, cv::Vec4b>(sheet.image, col, row);
  const float opacity = ink[3] / 255;
  return under * (dark * (1 - opacity)) + cv::Vec3f(ink[0], ink[1], ink[2]) * opacity;
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
  for (const auto& [key, draw] : kBoxKinds)
    if (kind == key) draw(faces, random);
  for (cv::Mat& side : faces.sides) shade_side(side);
  return faces;
}

std::vector<std::string> surface_kinds() { return keys_of(kSurfaceKinds); }

Eigen::Vector2d texel_place(const PaintedFace& face, double col, double row, double per_meter) {
  return {(col + 0.5) / per_meter - face.size.x() / 2, face.size.y() / 2 - (row + 0.5) / per_meter};
}

cv::Mat empty_map(const PaintedFace& face, double per_meter, int type) {
  return cv::Mat(cvCeil(face.size.y() * per_meter), cvCeil(face.size.x() * per_meter), type);
}

cv::Mat paint_face(const PaintedFace& face,
                   const std::string& kind,
                   std::uint64_t seed,
                   int threads) {
  const double per_meter = kFaceTexelsPerMeter / face.scale;
  cv::Mat texture = empty_map(face, per_meter, CV_8UC3);
  const auto color = std::ranges::find(kSurfaceKinds, kind, &SurfaceKind::first)->second;
  in_parallel(texture.rows, threads, [&](int row) {
    for (int col = 0; col < texture.cols; ++col) {
      const Eigen::Vector2d p = texel_place(face, col, row, per_meter) / face.scale;
      texture.at<cv::Vec3b>(row, col) = color(p.x(), p.y(), seed);
    }
  });
  return texture;
}

void lay_sheet(cv::Mat& texture, const PaintedFace& face, const Sheet& sheet, int threads) {
  const double per_meter = kFaceTexelsPerMeter / face.scale;
  const double reach = sheet.size.norm() / 2 + 0.01 * face.scale;
  const double left = (sheet.center.x() - reach + face.size.x() / 2) * per_meter;
  const double top = (face.size.y() / 2 - sheet.center.y() - reach) * per_meter;
  const int side = cvCeil(2 * reach * per_meter);
  const cv::Rect area =
      cv::Rect(cvFloor(left), cvFloor(top), side, side) & cv::Rect({}, texture.size());
  in_parallel(area.height, threads, [&](int i) {
    const int row = area.y + i;
    for (int col = area.x; col < area.x + area.width; ++col) {
      const cv::Vec3f under = texture.at<cv::Vec3b>(row, col);
      cv::Vec3f sum(0, 0, 0);
      for (const double dr : {-0.25, 0.25})
        for (const double dc : {-0.25, 0.25})
          sum += cover(under, sheet, texel_place(face, col + dc, row + dr, per_meter), face.scale);
      texture.at<cv::Vec3b>(row, col) = sum / 4;
    }
  });
}

}  // namespace gpo
