// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/scene.h"

#include "engine/base/parallel.h"
#include "engine/synthesis/random.h"
#include "engine/synthesis/textures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr double kDeskTexelsPerMeter = 1600;
constexpr double kSheetTexelsPerMeter = 2600;
constexpr double kLightTexelsPerMeter = 400;
const cv::Vec3f kBoardPaper(232, 237, 239);

Eigen::Vector2d texel_place(const DeskRecipe& desk, double col, double row, double per_meter) {
  return {(col + 0.5) / per_meter - desk.size.x() / 2, desk.size.y() / 2 - (row + 0.5) / per_meter};
}

cv::Mat empty_map(const DeskRecipe& desk, double per_meter, int type) {
  return cv::Mat(cvCeil(desk.size.y() * per_meter), cvCeil(desk.size.x() * per_meter), type);
}

/// Oiled oak in planks along x.
cv::Vec3f wood(double x, double y, std::uint64_t seed) {
  constexpr double kPlank = 0.21;
  const double plank = std::floor(y / kPlank);
  const double in_plank = y / kPlank - plank;
  const auto board_seed =
      seed + static_cast<std::uint64_t>(static_cast<std::int64_t>(plank) + 1000);
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
  // The joint between two planks is a soft dark line.
  const double joint = std::min(in_plank, 1 - in_plank) * kPlank;
  return color * static_cast<float>(1 - 0.45 * std::exp(-joint * joint / (2 * 0.0008 * 0.0008)));
}

void paint_wood(cv::Mat& texture, const DeskRecipe& desk, int threads) {
  in_parallel(texture.rows, threads, [&](int row) {
    for (int col = 0; col < texture.cols; ++col) {
      const Eigen::Vector2d p = texel_place(desk, col, row, kDeskTexelsPerMeter);
      const cv::Vec3f color = wood(p.x(), p.y(), desk.texture_seed);
      texture.at<cv::Vec3b>(row, col) = cv::Vec3b(cv::saturate_cast<uchar>(color[0]),
                                                  cv::saturate_cast<uchar>(color[1]),
                                                  cv::saturate_cast<uchar>(color[2]));
    }
  });
}

/// A sheet on the desk; `picture` is CV_8UC4 and seen with +y of the sheet at the picture's top.
struct Sheet {
  Eigen::Vector2d center;
  Eigen::Vector2d size;
  Eigen::Matrix2d turn;  ///< from the world into the sheet's axes
  cv::Mat picture;
};

cv::Vec4f interpolate(const cv::Mat& picture, double col, double row) {
  const double x = std::clamp(col, 0.0, picture.cols - 1.001);
  const double y = std::clamp(row, 0.0, picture.rows - 1.001);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const auto a = static_cast<float>(x - x0);
  const auto b = static_cast<float>(y - y0);
  const auto at = [&](int r, int c) { return cv::Vec4f(picture.at<cv::Vec4b>(r, c)); };
  return (at(y0, x0) * (1 - a) + at(y0, x0 + 1) * a) * (1 - b) +
         (at(y0 + 1, x0) * (1 - a) + at(y0 + 1, x0 + 1) * a) * b;
}

/// The color of the desk with the sheet over it; a soft shadow runs around the sheet.
cv::Vec3f cover(const cv::Vec3f& under, const Sheet& sheet, const Eigen::Vector2d& place) {
  const Eigen::Vector2d in_sheet = sheet.turn * (place - sheet.center);
  const Eigen::Array2d outside = in_sheet.array().abs() - sheet.size.array() / 2;
  const double distance = outside.max(0).matrix().norm();
  const float dark = distance > 0.006 ? 1.0F : static_cast<float>(0.72 + 0.28 * distance / 0.006);
  if (outside.maxCoeff() > 0) return under * dark;
  const double col = (in_sheet.x() / sheet.size.x() + 0.5) * sheet.picture.cols - 0.5;
  const double row = (0.5 - in_sheet.y() / sheet.size.y()) * sheet.picture.rows - 0.5;
  const cv::Vec4f ink = interpolate(sheet.picture, col, row);
  const float opacity = ink[3] / 255;
  return under * (dark * (1 - opacity)) + cv::Vec3f(ink[0], ink[1], ink[2]) * opacity;
}

void lay_sheet(cv::Mat& texture, const DeskRecipe& desk, const Sheet& sheet, int threads) {
  const double reach = sheet.size.norm() / 2 + 0.01;
  const double left = (sheet.center.x() - reach + desk.size.x() / 2) * kDeskTexelsPerMeter;
  const double top = (desk.size.y() / 2 - sheet.center.y() - reach) * kDeskTexelsPerMeter;
  const int side = cvCeil(2 * reach * kDeskTexelsPerMeter);
  const cv::Rect area =
      cv::Rect(cvFloor(left), cvFloor(top), side, side) & cv::Rect({}, texture.size());
  in_parallel(area.height, threads, [&](int i) {
    const int row = area.y + i;
    for (int col = area.x; col < area.x + area.width; ++col) {
      const cv::Vec3f under = texture.at<cv::Vec3b>(row, col);
      cv::Vec3f sum(0, 0, 0);
      for (const double dr : {-0.25, 0.25}) {
        for (const double dc : {-0.25, 0.25}) {
          sum += cover(under, sheet, texel_place(desk, col + dc, row + dr, kDeskTexelsPerMeter));
        }
      }
      texture.at<cv::Vec3b>(row, col) = cv::Vec3b(cv::saturate_cast<uchar>(sum[0] / 4),
                                                  cv::saturate_cast<uchar>(sum[1] / 4),
                                                  cv::saturate_cast<uchar>(sum[2] / 4));
    }
  });
}

std::vector<cv::Point> footprint(const DeskRecipe& desk,
                                 const BoxRecipe& box,
                                 const Eigen::Vector2d& shift) {
  std::vector<cv::Point> corners;
  for (const auto& [x, y] : {std::pair{-.5, -.5}, {.5, -.5}, {.5, .5}, {-.5, .5}}) {
    const Eigen::Vector2d p = box.center + shift +
                              turn_into(-box.angle).topLeftCorner<2, 2>() *
                                  Eigen::Vector2d(x * box.size.x(), y * box.size.y());
    corners.emplace_back(cvRound((p.x() + desk.size.x() / 2) * kLightTexelsPerMeter),
                         cvRound((desk.size.y() / 2 - p.y()) * kLightTexelsPerMeter));
  }
  return corners;
}

/// Shadow of all boxes in the light of a broad window at the back on the left, 0 .. 1.
cv::Mat cast_shadows(const DeskRecipe& desk) {
  cv::Mat sum = empty_map(desk, kLightTexelsPerMeter, CV_32FC1);
  sum.setTo(0);
  constexpr int kLights = 25;
  for (int i = 0; i < kLights; ++i) {
    const int line = i / 5;
    cv::Mat shadow(sum.size(), CV_8UC1, cv::Scalar(0));
    const Eigen::Vector2d slope(0.35 + 0.10 * (i % 5), -0.10 - 0.08 * line);
    for (const BoxRecipe& box : desk.boxes) {
      auto corners = footprint(desk, box, slope * box.base);
      const auto high = footprint(desk, box, slope * (box.base + box.size.z()));
      corners.insert(corners.end(), high.begin(), high.end());
      std::vector<cv::Point> hull;
      cv::convexHull(corners, hull);
      cv::fillConvexPoly(shadow, hull, 255, cv::LINE_AA);
    }
    cv::accumulateWeighted(shadow, sum, 1.0 / (i + 1));
  }
  return sum / 255;
}

cv::Mat make_light(const DeskRecipe& desk) {
  cv::Mat light = empty_map(desk, kLightTexelsPerMeter, CV_32FC1);
  const cv::Mat shadow = cast_shadows(desk);
  cv::Mat contact(light.size(), CV_32FC1, cv::Scalar(0));
  for (const BoxRecipe& box : desk.boxes) {
    if (box.base == 0) cv::fillConvexPoly(contact, footprint(desk, box, {0, 0}), 1.0, cv::LINE_8);
  }
  cv::GaussianBlur(contact, contact, {}, 0.012 * kLightTexelsPerMeter);
  for (int row = 0; row < light.rows; ++row) {
    for (int col = 0; col < light.cols; ++col) {
      const Eigen::Vector2d p = texel_place(desk, col, row, kLightTexelsPerMeter);
      const double lamp = 0.74 + 0.3 * std::exp(-(p - Eigen::Vector2d(-0.15, 0.15)).squaredNorm());
      light.at<float>(row, col) = static_cast<float>(lamp * (1 - 0.5 * shadow.at<float>(row, col)) *
                                                     (1 - 0.4 * contact.at<float>(row, col)));
    }
  }
  return light;
}

void apply_light(Scene& scene, int threads) {
  in_parallel(scene.desk.rows, threads, [&](int row) {
    for (int col = 0; col < scene.desk.cols; ++col) {
      const float light = sample_texture(
          scene.light, (col + 0.5) / scene.desk.cols, (row + 0.5) / scene.desk.rows)[0];
      auto& texel = scene.desk.at<cv::Vec3b>(row, col);
      for (int k = 0; k < 3; ++k) {
        texel[k] = cv::saturate_cast<uchar>(static_cast<float>(texel[k]) * light);
      }
    }
  });
}

SceneBox make_box(const BoxRecipe& box, Random random) {
  const Eigen::Vector3d px = box.size * kSheetTexelsPerMeter;
  const BoxFaces faces = draw_box(box.kind, {px.x(), px.y(), px.z()}, random);
  SceneBox scene_box{
      {box.center.x(), box.center.y(), box.base}, box.size, turn_into(box.angle), {}, {}};
  const std::array<double, 4> light = {0.74, 0.62, 0.9, 0.95};
  for (std::size_t i = 0; i < light.size(); ++i) {
    cv::cvtColor(faces.sides[i], scene_box.sides[i], cv::COLOR_BGRA2BGR);
    scene_box.sides[i].convertTo(scene_box.sides[i], -1, light[i]);
  }
  cv::cvtColor(faces.top, scene_box.top, cv::COLOR_BGRA2BGR);
  return scene_box;
}

}  // namespace

Scene make_scene(const DeskRecipe& desk, int threads) {
  Scene scene;
  scene.desk_size = desk.size;
  scene.board = desk.board;
  scene.desk = empty_map(desk, kDeskTexelsPerMeter, CV_8UC3);
  paint_wood(scene.desk, desk, threads);
  for (std::size_t i = 0; i < desk.prints.size(); ++i) {
    const PrintRecipe& print = desk.prints[i];
    const cv::Size size(cvRound(print.size.x() * kSheetTexelsPerMeter),
                        cvRound(print.size.y() * kSheetTexelsPerMeter));
    const Random random(desk.texture_seed, 100 + i);
    lay_sheet(scene.desk,
              desk,
              {print.center,
               print.size,
               turn_into(print.angle).topLeftCorner<2, 2>(),
               draw_print(print.kind, size, random)},
              threads);
  }
  if (desk.board) {
    const BoardRecipe& board = *desk.board;
    scene.R_board_world = turn_into(board.angle);
    const Eigen::Vector2d size = Eigen::Vector2d(board.columns + 1, board.rows + 1) * board.square +
                                 Eigen::Vector2d::Constant(2 * board.margin);
    const cv::Mat paper(
        8, 8, CV_8UC4, cv::Scalar(kBoardPaper[0], kBoardPaper[1], kBoardPaper[2], 255));
    lay_sheet(scene.desk,
              desk,
              {board.center, size, scene.R_board_world.topLeftCorner<2, 2>(), paper},
              threads);
  }
  scene.light = make_light(desk);
  apply_light(scene, threads);
  for (std::size_t i = 0; i < desk.boxes.size(); ++i) {
    scene.boxes.push_back(make_box(desk.boxes[i], Random(desk.texture_seed, 1000 + i)));
  }
  return scene;
}

cv::Vec3f sample_texture(const cv::Mat& texture, double u, double v) {
  const double x = std::clamp(u * texture.cols - 0.5, 0.0, texture.cols - 1.001);
  const double y = std::clamp(v * texture.rows - 0.5, 0.0, texture.rows - 1.001);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const auto a = static_cast<float>(x - x0);
  const auto b = static_cast<float>(y - y0);
  if (texture.type() == CV_32FC1) {
    const auto* top = texture.ptr<float>(y0) + x0;
    const auto* bottom = texture.ptr<float>(y0 + 1) + x0;
    const float value =
        (top[0] * (1 - a) + top[1] * a) * (1 - b) + (bottom[0] * (1 - a) + bottom[1] * a) * b;
    return {value, value, value};
  }
  const auto* top = texture.ptr<cv::Vec3b>(y0) + x0;
  const auto* bottom = texture.ptr<cv::Vec3b>(y0 + 1) + x0;
  cv::Vec3f color;
  for (int k = 0; k < 3; ++k) {
    color[k] = (top[0][k] * (1 - a) + top[1][k] * a) * (1 - b) +
               (bottom[0][k] * (1 - a) + bottom[1][k] * a) * b;
  }
  return color;
}

}  // namespace gpo
