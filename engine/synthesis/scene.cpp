// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "engine/synthesis/drawing.h"
#include "engine/synthesis/renderer.h"

#include <cmath>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr double kLightTexelsPerMeter = 400;  // at scale 1
const cv::Scalar kBoardPaper(232, 237, 239, 255);

struct FaceRecipe {
  PaintedFace face;
  const std::string& surface;
  std::uint64_t seed;
  const std::vector<PrintRecipe>& prints;
  Eigen::Vector2d origin;
};

cv::Mat paint_with_prints(const FaceRecipe& recipe, int threads) {
  const auto& [face, surface, seed, prints, origin] = recipe;
  cv::Mat texture = paint_face(face, surface, seed, threads);
  const double per_meter = kSheetTexelsPerMeter / face.scale;
  for (std::size_t i = 0; i < prints.size(); ++i) {
    const PrintRecipe& print = prints[i];
    const cv::Size size(cvRound(print.size.x() * per_meter), cvRound(print.size.y() * per_meter));
    lay_sheet(texture,
              face,
              {origin + print.center,
               print.size,
               turn_into(print.angle).topLeftCorner<2, 2>(),
               draw_print(print.kind, size, Random(seed, 100 + i))},
              threads);
  }
  return texture;
}

PaintedFace face_of(const DeskRecipe& desk) { return {desk.size, desk.scale}; }

double light_texels(const DeskRecipe& desk) { return kLightTexelsPerMeter / desk.scale; }

cv::Point light_texel(const DeskRecipe& desk, const Eigen::Vector2d& place) {
  const double per_meter = light_texels(desk);
  return {cvRound((place.x() + desk.size.x() / 2) * per_meter),
          cvRound((desk.size.y() / 2 - place.y()) * per_meter)};
}

std::vector<cv::Point> footprint(const DeskRecipe& desk,
                                 const BoxRecipe& box,
                                 const Eigen::Vector2d& shift) {
  std::vector<cv::Point> corners;
  for (const auto& [x, y] : {std::pair{-.5, -.5}, {.5, -.5}, {.5, .5}, {-.5, .5}}) {
    const Eigen::Vector2d p = box.center + shift +
                              turn_into(-box.angle).topLeftCorner<2, 2>() *
                                  Eigen::Vector2d(x * box.size.x(), y * box.size.y());
    corners.push_back(light_texel(desk, p));
  }
  return corners;
}

cv::Mat cast_shadows(const DeskRecipe& desk) {
  cv::Mat sum = empty_map(face_of(desk), light_texels(desk), CV_32FC1);
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
  cv::Mat light = empty_map(face_of(desk), light_texels(desk), CV_32FC1);
  const cv::Mat shadow = cast_shadows(desk);
  cv::Mat contact(light.size(), CV_32FC1, cv::Scalar(0));
  for (const BoxRecipe& box : desk.boxes)
    if (box.base == 0) cv::fillConvexPoly(contact, footprint(desk, box, {0, 0}), 1.0, cv::LINE_8);
  for (const WallRecipe& wall : desk.walls)
    cv::line(contact, light_texel(desk, wall.from), light_texel(desk, wall.to), 1.0, 12);
  cv::GaussianBlur(contact, contact, {}, 0.012 * kLightTexelsPerMeter);
  for (int row = 0; row < light.rows; ++row) {
    for (int col = 0; col < light.cols; ++col) {
      const Eigen::Vector2d p =
          texel_place(face_of(desk), col, row, light_texels(desk)) / desk.scale;
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
      texel = cv::Vec3f(texel) * light;
    }
  });
}

SceneBox make_box(const BoxRecipe& box, double scale, Random random) {
  const Eigen::Vector3d px = box.size * (kSheetTexelsPerMeter / scale);
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

/// Less if the wall faces away from the window at the back on the left, and towards its foot.
float wall_light(const SceneWall& wall, double height, double scale) {
  const Eigen::Vector3d facing(wall.along.y(), -wall.along.x(), 0);
  const double direct = 0.84 + 0.12 * facing.dot(Eigen::Vector3d(-0.8, -0.6, 0));
  return static_cast<float>(direct * (1 - 0.25 * std::exp(-height / (0.06 * scale))));
}

SceneWall make_wall(const WallRecipe& recipe, double scale, int threads) {
  const Eigen::Vector2d foot = recipe.to - recipe.from;
  SceneWall wall;
  wall.foot = {recipe.from.x(), recipe.from.y(), 0};
  wall.along = Eigen::Vector3d(foot.x(), foot.y(), 0).normalized();
  wall.size = {foot.norm(), recipe.height};
  wall.texture = paint_with_prints(
      {{wall.size, scale}, recipe.surface, recipe.texture_seed, recipe.prints, -wall.size / 2},
      threads);
  for (int row = 0; row < wall.texture.rows; ++row) {
    const double height = (1 - (row + 0.5) / wall.texture.rows) * wall.size.y();
    cv::Mat pixels = wall.texture.row(row);
    pixels.convertTo(pixels, -1, wall_light(wall, height, scale));
  }
  return wall;
}

Scene make_desk(const DeskRecipe& desk, int threads) {
  Scene scene;
  scene.desk_size = desk.size;
  scene.board = desk.board;
  scene.desk = paint_with_prints(
      {face_of(desk), desk.surface, desk.texture_seed, desk.prints, {0, 0}}, threads);
  if (desk.board) {
    const BoardRecipe& board = *desk.board;
    scene.R_board_world = turn_into(board.angle);
    const Eigen::Vector2d size = Eigen::Vector2d(board.columns + 1, board.rows + 1) * board.square +
                                 Eigen::Vector2d::Constant(2 * board.margin);
    const cv::Mat paper(8, 8, CV_8UC4, kBoardPaper);
    lay_sheet(scene.desk,
              face_of(desk),
              {board.center, size, scene.R_board_world.topLeftCorner<2, 2>(), paper},
              threads);
  }
  scene.light = make_light(desk);
  apply_light(scene, threads);
  for (std::size_t i = 0; i < desk.boxes.size(); ++i) {
    check_stop();
    scene.boxes.push_back(make_box(desk.boxes[i], desk.scale, Random(desk.texture_seed, 1000 + i)));
  }
  for (const WallRecipe& wall : desk.walls)
    scene.walls.push_back(make_wall(wall, desk.scale, threads));
  return scene;
}

constexpr int kStone = 144;  // texels along an edge of the block of stone

template <int N>
Eigen::Vector<double, N> pick_direction(Random& random) {
  Eigen::Vector<double, N> v;
  for (double& coordinate : v) coordinate = random.normal();
  return v.normalized();
}

const std::array<cv::Vec3f, 4> kTints = {
    {{0.80F, 0.92F, 1.0F}, {0.97F, 0.98F, 1.0F}, {0.66F, 0.80F, 1.0F}, {0.98F, 1.0F, 0.94F}}};

SceneRock make_rock(const RubbleRecipe& heap, Random random) {
  SceneRock rock;
  for (int k = 0; k < 3; ++k) rock.center[k] = random.uniform(heap.low[k], heap.high[k]);
  const double pick = random.uniform();
  rock.reach = (heap.size[0] + (heap.size[1] - heap.size[0]) * pick * pick) / 2;
  Eigen::Vector3d axes;
  for (double& axis : axes) axis = rock.reach * random.uniform(0.6, 1);
  rock.R_unit_world = axes.cwiseInverse().asDiagonal() *
                      Eigen::Quaterniond(pick_direction<4>(random)).toRotationMatrix();
  constexpr int kCuts = 9;
  for (int i = 0; i < kCuts; ++i) {
    const Eigen::Vector3d normal = pick_direction<3>(random);
    rock.cuts.push_back({normal, random.uniform(0.62, 0.96)});
  }
  rock.tint = random.pick(kTints);
  rock.tint *= static_cast<float>(random.uniform(0.7, 1.15));
  rock.grain = random.uniform(0.6, 1);
  return rock;
}

double brightness(const Eigen::Vector3d& p) {
  const double tone = fractal_noise(3 * p, 4, 1);
  const double grain = fractal_noise(13 * p, 2, 2);
  const double crack = std::abs(fractal_noise(4 * p, 3, 3) - 0.5);
  const double speck = std::clamp((fractal_noise(19 * p, 1, 4) - 0.68) * 9, 0.0, 1.0);
  const double base = 0.5 + 1.1 * (tone - 0.5) + 0.75 * (grain - 0.5);
  return (base + 0.35 * speck) * (1 - 0.6 * std::exp(-crack * crack / (2 * 0.012 * 0.012)));
}

cv::Mat make_stone(int threads) {
  cv::Mat stone(std::vector{kStone, kStone, kStone}, CV_8UC1);
  in_parallel(kStone, threads, [&](int i) {
    for (int j = 0; j < kStone; ++j) {
      for (int k = 0; k < kStone; ++k) {
        const Eigen::Vector3d place = Eigen::Vector3d(i, j, k) * (2.0 / (kStone - 1));
        stone.at<uchar>(i, j, k) = cv::saturate_cast<uchar>(255 * brightness(place));
      }
    }
  });
  return stone;
}

}  // namespace

Scene make_scene(const Recipe& recipe, int threads) {
  Scene scene;
  if (has_desk(recipe)) scene = make_desk(recipe.desk, threads);
  if (recipe.rubble.empty()) return scene;
  scene.stone = make_stone(threads);
  for (const RubbleRecipe& heap : recipe.rubble)
    for (int i = 0; i < heap.count; ++i)
      scene.rocks.push_back(make_rock(heap, Random(heap.seed, static_cast<std::uint64_t>(i))));
  return scene;
}

cv::Vec3f sample_texture(const cv::Mat& texture, double u, double v) {
  const double col = u * texture.cols - 0.5;
  const double row = v * texture.rows - 0.5;
  return texture.type() == CV_32FC1 ? cv::Vec3f::all(bilinear<float, float>(texture, col, row))
                                    : bilinear<cv::Vec3f, cv::Vec3b>(texture, col, row);
}

}  // namespace gpo
