// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/scene.h"

#include "engine/base/parallel.h"
#include "engine/synthesis/drawing.h"
#include "engine/synthesis/random.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr double kLightTexelsPerMeter = 400;  ///< at scale 1
const cv::Vec3f kBoardPaper(232, 237, 239);

struct PrintLayout {
  const std::vector<PrintRecipe>& prints;
  Eigen::Vector2d origin;  ///< from which their centers are
  std::uint64_t seed;
};

/// Draws the prints and lays them, the last one on top.
void lay_prints(cv::Mat& texture,
                const PaintedFace& face,
                const PrintLayout& layout,
                int threads,
                const std::function<void()>& step) {
  step();
  const auto& [prints, origin, seed] = layout;
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
    step();
  }
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

/// Shadow of all boxes in the light of a broad window at the back on the left, 0 .. 1.
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
  for (const BoxRecipe& box : desk.boxes) {
    if (box.base == 0) cv::fillConvexPoly(contact, footprint(desk, box, {0, 0}), 1.0, cv::LINE_8);
  }
  for (const WallRecipe& wall : desk.walls) {
    cv::line(contact, light_texel(desk, wall.from), light_texel(desk, wall.to), 1.0, 12);
  }
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
      for (int k = 0; k < 3; ++k) {
        texel[k] = cv::saturate_cast<uchar>(static_cast<float>(texel[k]) * light);
      }
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

/// Light on a wall: less the more it faces the window at the back on the left from behind, and less
/// towards its foot.
float wall_light(const SceneWall& wall, double height, double scale) {
  const Eigen::Vector3d facing(wall.along.y(), -wall.along.x(), 0);
  const double direct = 0.84 + 0.12 * facing.dot(Eigen::Vector3d(-0.8, -0.6, 0));
  return static_cast<float>(direct * (1 - 0.25 * std::exp(-height / (0.06 * scale))));
}

SceneWall make_wall(const WallRecipe& recipe,
                    double scale,
                    int threads,
                    const std::function<void()>& step) {
  const Eigen::Vector2d foot = recipe.to - recipe.from;
  SceneWall wall;
  wall.foot = {recipe.from.x(), recipe.from.y(), 0};
  wall.along = Eigen::Vector3d(foot.x(), foot.y(), 0).normalized();
  wall.size = {foot.norm(), recipe.height};
  const PaintedFace face{wall.size, scale};
  wall.texture = paint_face(face, recipe.surface, recipe.texture_seed, threads);
  lay_prints(
      wall.texture, face, {recipe.prints, -wall.size / 2, recipe.texture_seed}, threads, step);
  for (int row = 0; row < wall.texture.rows; ++row) {
    const double height = (1 - (row + 0.5) / wall.texture.rows) * wall.size.y();
    cv::Mat pixels = wall.texture.row(row);
    pixels.convertTo(pixels, -1, wall_light(wall, height, scale));
  }
  return wall;
}

}  // namespace

Scene make_scene(const DeskRecipe& desk, int threads, const std::function<void()>& step) {
  Scene scene;
  scene.desk_size = desk.size;
  scene.board = desk.board;
  scene.desk = paint_face(face_of(desk), desk.surface, desk.texture_seed, threads);
  lay_prints(scene.desk, face_of(desk), {desk.prints, {0, 0}, desk.texture_seed}, threads, step);
  if (desk.board) {
    const BoardRecipe& board = *desk.board;
    scene.R_board_world = turn_into(board.angle);
    const Eigen::Vector2d size = Eigen::Vector2d(board.columns + 1, board.rows + 1) * board.square +
                                 Eigen::Vector2d::Constant(2 * board.margin);
    const cv::Mat paper(
        8, 8, CV_8UC4, cv::Scalar(kBoardPaper[0], kBoardPaper[1], kBoardPaper[2], 255));
    lay_sheet(scene.desk,
              face_of(desk),
              {board.center, size, scene.R_board_world.topLeftCorner<2, 2>(), paper},
              threads);
  }
  scene.light = make_light(desk);
  step();
  apply_light(scene, threads);
  step();
  for (std::size_t i = 0; i < desk.boxes.size(); ++i) {
    scene.boxes.push_back(make_box(desk.boxes[i], desk.scale, Random(desk.texture_seed, 1000 + i)));
    step();
  }
  for (const WallRecipe& wall : desk.walls) {
    scene.walls.push_back(make_wall(wall, desk.scale, threads, step));
  }
  return scene;
}

Scene make_scene(const Recipe& recipe, int threads, const std::function<void()>& step) {
  Scene scene;
  if (has_desk(recipe)) scene = make_scene(recipe.desk, threads, step);
  if (recipe.rubble.empty()) return scene;
  step();
  scene.stone = make_stone(threads);
  for (const RubbleRecipe& heap : recipe.rubble) pile_rocks(scene.rocks, heap);
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

// Slabs.
BoxHit hit_box(const SceneBox& box, const Ray& ray, double farthest) {
  const Eigen::Vector3d low(-box.size.x() / 2, -box.size.y() / 2, 0);
  const Eigen::Vector3d high(box.size.x() / 2, box.size.y() / 2, box.size.z());
  BoxHit hit{0, 0};
  double leave = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double a = (low[k] - ray.origin[k]) / ray.along[k];
    const double b = (high[k] - ray.origin[k]) / ray.along[k];
    if (std::min(a, b) > hit.t) hit = {std::min(a, b), k};
    leave = std::min(leave, std::max(a, b));
  }
  if (!(hit.t > 0 && hit.t <= leave && hit.t < farthest)) return {};
  return hit;
}

cv::Vec3f box_color(const SceneBox& box, const BoxHit& hit, const Ray& ray) {
  const Eigen::Vector3d p = (ray.origin + hit.t * ray.along).cwiseQuotient(box.size);
  if (hit.axis == 2) return sample_texture(box.top, p.x() + 0.5, 0.5 - p.y());
  if (hit.axis == 0) {
    return ray.along.x() < 0 ? sample_texture(box.sides[1], p.y() + 0.5, 1 - p.z())
                             : sample_texture(box.sides[3], 0.5 - p.y(), 1 - p.z());
  }
  return ray.along.y() > 0 ? sample_texture(box.sides[0], p.x() + 0.5, 1 - p.z())
                           : sample_texture(box.sides[2], 0.5 - p.x(), 1 - p.z());
}

WallHit hit_wall(const SceneWall& wall, const Ray& ray) {
  const Eigen::Vector3d normal(wall.along.y(), -wall.along.x(), 0);
  const double t = normal.dot(wall.foot - ray.origin) / normal.dot(ray.along);
  if (!(t > 0) || !std::isfinite(t)) return {};
  const Eigen::Vector3d p = ray.origin + t * ray.along - wall.foot;
  const double u = p.dot(wall.along) / wall.size.x();
  const double v = 1 - p.z() / wall.size.y();
  if (u < 0 || u > 1 || v < 0 || v > 1) return {};
  return {t, u, v};
}

// The sphere's chord, shortened by each half-space.
RockHit hit_rock(const SceneRock& rock, const Ray& ray, double farthest) {
  const double a = ray.along.squaredNorm();
  const double b = ray.origin.dot(ray.along);
  const double inside = b * b - a * (ray.origin.squaredNorm() - 1);
  if (inside < 0) return {};
  RockHit hit;
  hit.t = (-b - std::sqrt(inside)) / a;
  if (hit.t >= farthest) return {};  // cuts only move it away
  hit.normal = ray.origin + hit.t * ray.along;
  double leave = (-b + std::sqrt(inside)) / a;
  for (const SceneRock::Cut& cut : rock.cuts) {
    const double slope = cut.normal.dot(ray.along);
    const double within = cut.distance - cut.normal.dot(ray.origin);
    if (slope > 0) {
      leave = std::min(leave, within / slope);
    } else if (slope < 0 && within / slope > hit.t) {
      hit = {within / slope, cut.normal};
    } else if (slope == 0 && within < 0) {
      return {};
    }
  }
  if (!(hit.t > 0 && hit.t <= leave && hit.t < farthest)) return {};
  return hit;
}

/// Light from the sky, and more of it from above on the left.
cv::Vec3f rock_color(const SceneRock& rock,
                     const cv::Mat& stone,
                     const RockHit& hit,
                     const Ray& ray) {
  const Eigen::Vector3d lamp(-0.48, -0.36, 0.8);
  const Eigen::Vector3d normal = (rock.R_unit_world.transpose() * hit.normal).normalized();
  const double light = 0.34 + 0.2 * normal.z() + 0.75 * std::max(0.0, normal.dot(lamp));
  const Eigen::Vector3d place = rock.grain * (ray.origin + hit.t * ray.along);
  return rock.tint * (static_cast<float>(light) * sample_stone(stone, place));
}

}  // namespace gpo
