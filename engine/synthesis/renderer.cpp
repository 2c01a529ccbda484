// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/renderer.h"

#include "engine/base/parallel.h"
#include "engine/synthesis/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

const cv::Vec3f kBoardWhite(232, 237, 239);
const cv::Vec3f kBoardBlack(38, 36, 36);
constexpr double kFloorHeight = -0.73;  // [m]
constexpr double kMiss = std::numeric_limits<double>::infinity();

/// origin + t along, in the axes of the thing that it meets.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d along;  ///< not a unit vector: t is the same in all axes
};

// The first point where a ray meets a thing: 0 < t < farthest, infinite for a miss.

struct BoxHit {
  double t = kMiss;
  int axis = 0;  ///< across the face
};
BoxHit hit_box(const SceneBox& box, const Ray& ray, double farthest) {
  const Eigen::Vector3d low(-box.size.x() / 2, -box.size.y() / 2, 0);
  const Eigen::Vector3d high(box.size.x() / 2, box.size.y() / 2, box.size.z());
  BoxHit hit{0, 0};
  double leave = kMiss;
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
  if (hit.axis == 0)
    return ray.along.x() < 0 ? sample_texture(box.sides[1], p.y() + 0.5, 1 - p.z())
                             : sample_texture(box.sides[3], 0.5 - p.y(), 1 - p.z());
  return ray.along.y() > 0 ? sample_texture(box.sides[0], p.x() + 0.5, 1 - p.z())
                           : sample_texture(box.sides[2], 0.5 - p.x(), 1 - p.z());
}

struct WallHit {
  double t = kMiss;
  double u = 0;  ///< fraction of the wall's length, from its foot
  double v = 0;  ///< fraction of its height, from the top down
};
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

struct RockHit {
  double t = kMiss;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< in the axes of the rock
};
/// In the axes of the rock: the chord of the sphere, shortened by each half-space.
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

/// Brightness of the block of stone, interpolated, at a place in [-1, 1]^3.
float sample_stone(const cv::Mat& stone, const Eigen::Vector3d& place) {
  const int texels = stone.size[0];
  int at[3];
  float part[3];
  for (int k = 0; k < 3; ++k) {
    const double x = std::clamp((place[k] + 1) / 2 * (texels - 1), 0.0, texels - 1.001);
    at[k] = static_cast<int>(x);
    part[k] = static_cast<float>(x - at[k]);
  }
  const auto along = [&](int i, int j) {
    const uchar* p = stone.ptr<uchar>(at[0] + i, at[1] + j) + at[2];
    return static_cast<float>(p[0]) * (1 - part[2]) + static_cast<float>(p[1]) * part[2];
  };
  const float near = along(0, 0) * (1 - part[1]) + along(0, 1) * part[1];
  const float far = along(1, 0) * (1 - part[1]) + along(1, 1) * part[1];
  return near * (1 - part[0]) + far * part[0];
}

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

struct Seen {
  Eigen::Vector3d eye;
  Eigen::Matrix3d R_own_c;
  std::optional<Cone> cone;  ///< around its bounding sphere; nullopt for an eye in that sphere

  Ray ray(const Eigen::Vector3d& ray_c) const { return {eye, R_own_c * ray_c}; }
};

/// A camera pose and all things seen from it: boxes, then rocks.
struct Eye {
  Pose pose;
  std::vector<Seen> things;
};

std::vector<Eye> make_eyes(const Scene& scene, const std::vector<Pose>& poses) {
  std::vector<Eye> eyes;
  for (const Pose& pose : poses) {
    Eye& eye = eyes.emplace_back(Eye{pose, {}});
    const auto see = [&](const Eigen::Matrix3d& R_own_world,
                         const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& middle,
                         double radius2) {
      Seen& thing = eye.things.emplace_back(
          Seen{R_own_world * (pose.p_wc - origin), R_own_world * pose.R_wc, {}});
      const Eigen::Vector3d middle_c = to_camera(pose, middle);
      const double sine2 = radius2 / middle_c.squaredNorm();
      if (sine2 < 1) thing.cone = {middle_c.normalized(), std::sqrt(1 - sine2), std::sqrt(sine2)};
    };
    for (const SceneBox& box : scene.boxes) {
      const Eigen::Vector3d middle = box.origin + Eigen::Vector3d(0, 0, box.size.z() / 2);
      see(box.R_box_world, box.origin, middle, box.size.squaredNorm() / 4);
    }
    for (const SceneRock& rock : scene.rocks)
      see(rock.R_unit_world, rock.center, rock.center, rock.reach * rock.reach);
  }
  return eyes;
}

cv::Vec3f desk_color(const Scene& scene, double x, double y) {
  const double u = x / scene.desk_size.x() + 0.5;
  const double v = 0.5 - y / scene.desk_size.y();
  if (!scene.board) return sample_texture(scene.desk, u, v);
  const BoardRecipe& board = *scene.board;
  const Eigen::Matrix3d& R = scene.R_board_world;
  const double dx = x - board.center.x();
  const double dy = y - board.center.y();
  const double column = (R(0, 0) * dx + R(0, 1) * dy) / board.square + (board.columns + 1) / 2.0;
  const double row = (R(1, 0) * dx + R(1, 1) * dy) / board.square + (board.rows + 1) / 2.0;
  if (column < 0 || row < 0 || column >= board.columns + 1 || row >= board.rows + 1)
    return sample_texture(scene.desk, u, v);
  const bool black = (static_cast<int>(column) + static_cast<int>(row)) % 2 == 0;
  return (black ? kBoardBlack : kBoardWhite) * sample_texture(scene.light, u, v)[0];
}

cv::Vec3f room_color(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  const double level = ray.z() / ray.norm();
  const cv::Vec3f wall(96, 100, 104);
  if (level >= 0) return wall;
  const double distance = (kFloorHeight - origin.z()) / level;
  return wall + (cv::Vec3f(58, 62, 72) - wall) * static_cast<float>(std::exp(-distance / 3));
}

template <typename Hit>
struct Nearest {
  Hit hit;
  std::size_t which = 0;

  void take(const Hit& other, std::size_t i) {
    if (other.t < hit.t) *this = {other, i};
  }
};

cv::Vec3f trace(const Scene& scene,
                const Eye& eye,
                const std::vector<std::size_t>& candidates,
                const Eigen::Vector2f& slope) {
  if (!std::isfinite(slope.x())) return {0, 0, 0};
  const Eigen::Vector3d ray_c(slope.x(), slope.y(), 1);
  const Ray ray{eye.pose.p_wc, eye.pose.R_wc * ray_c};
  const std::size_t boxes = scene.boxes.size();
  Nearest<BoxHit> box;
  Nearest<RockHit> rock;
  for (const std::size_t i : candidates) {
    const Ray own = eye.things[i].ray(ray_c);
    if (i < boxes)
      box.take(hit_box(scene.boxes[i], own, box.hit.t), i);
    else
      rock.take(hit_rock(scene.rocks[i - boxes], own, rock.hit.t), i);
  }
  Nearest<WallHit> wall;
  for (std::size_t i = 0; i < scene.walls.size(); ++i) wall.take(hit_wall(scene.walls[i], ray), i);
  const double to_desk = -ray.origin.z() / ray.along.z();
  const double x = ray.origin.x() + to_desk * ray.along.x();
  const double y = ray.origin.y() + to_desk * ray.along.y();
  const bool on_desk =
      to_desk > 0 && std::abs(x) < scene.desk_size.x() / 2 && std::abs(y) < scene.desk_size.y() / 2;
  const double desk_t = on_desk ? to_desk : kMiss;
  const double t = std::min({box.hit.t, rock.hit.t, wall.hit.t, desk_t});
  if (!std::isfinite(t)) return room_color(ray.origin, ray.along);
  if (t == box.hit.t)
    return box_color(scene.boxes[box.which], box.hit, eye.things[box.which].ray(ray_c));
  if (t == rock.hit.t)
    return rock_color(
        scene.rocks[rock.which - boxes], scene.stone, rock.hit, eye.things[rock.which].ray(ray_c));
  if (t == wall.hit.t)
    return sample_texture(scene.walls[wall.which].texture, wall.hit.u, wall.hit.v);
  return desk_color(scene, x, y);
}

Eigen::Vector3d direction(const Eigen::Vector2f& slope) {
  return Eigen::Vector3d(slope.x(), slope.y(), 1).normalized();
}

std::optional<Cone> cone_around(std::span<const Eigen::Vector2f> slopes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& slope : slopes)
    if (std::isfinite(slope.x())) sum += direction(slope);
  if (sum.isZero()) return std::nullopt;
  const Eigen::Vector3d axis = sum.normalized();
  double cosine = 1;
  for (const auto& slope : slopes)
    if (std::isfinite(slope.x())) cosine = std::min(cosine, axis.dot(direction(slope)));
  cosine -= 1e-9;  // more than rounding
  return Cone{axis, cosine, std::sqrt(1 - cosine * cosine)};
}

std::vector<std::vector<std::size_t>> find_candidates(const std::vector<Eye>& eyes,
                                                      const std::optional<Cone>& cone) {
  const auto overlaps = [&cone](const Cone& other) {
    return cone->axis.dot(other.axis) >= cone->cosine * other.cosine - cone->sine * other.sine;
  };
  std::vector<std::vector<std::size_t>> candidates(eyes.size());
  for (std::size_t e = 0; cone && e < eyes.size(); ++e)
    for (std::size_t i = 0; i < eyes[e].things.size(); ++i)
      if (!eyes[e].things[i].cone || overlaps(*eyes[e].things[i].cone)) candidates[e].push_back(i);
  return candidates;
}

void render_span(const Scene& scene,
                 const RayMap& map,
                 const std::vector<Eye>& eyes,
                 const cv::Rect& part,
                 cv::Mat& light) {
  const std::size_t per_pixel = static_cast<std::size_t>(map.samples) * map.samples;
  const auto first = static_cast<std::size_t>(map.width) * part.y + part.x;
  const auto* ray = map.rays.data() + per_pixel * first;
  const auto span = static_cast<std::size_t>(map.spans()) * part.y + part.x / RayMap::kSpan;
  const auto candidates = find_candidates(eyes, map.cones[span]);
  for (int col = part.x; col < part.x + part.width; ++col) {
    cv::Vec3f sum(0, 0, 0);
    for (std::size_t k = 0; k < per_pixel; ++k) {
      // 23 is coprime to any number of samples, so times hardly depend on places in the pixel.
      const std::size_t time = (k * 23) % eyes.size();
      sum += trace(scene, eyes[time], candidates[time], *ray++);
    }
    light.at<cv::Vec3f>(part.y, col) = sum / static_cast<float>(per_pixel);
  }
}

void render_row(
    const Scene& scene, const RayMap& map, const std::vector<Eye>& eyes, int row, cv::Mat& light) {
  for (int col = 0; col < map.width; col += RayMap::kSpan)
    render_span(scene, map, eyes, {col, row, std::min(RayMap::kSpan, map.width - col), 1}, light);
}

}  // namespace

RayMap make_ray_map(const Camera& camera, int samples, int threads) {
  RayMap map{camera.width, camera.height, samples, {}, {}};
  const std::size_t per_pixel = static_cast<std::size_t>(samples) * samples;
  map.rays.resize(per_pixel * camera.width * camera.height);
  map.cones.resize(static_cast<std::size_t>(map.spans()) * camera.height);
  in_parallel(camera.height, threads, [&](int row) {
    auto* const first = map.rays.data() + per_pixel * camera.width * row;
    auto* ray = first;
    for (int col = 0; col < camera.width; ++col) {
      for (int k = 0; k < samples * samples; ++k) {
        const int line = k / samples;
        const Eigen::Vector2d offset((k % samples + 0.5) / samples - 0.5,
                                     (line + 0.5) / samples - 0.5);
        const Eigen::Vector2d px = undistort(camera, Eigen::Vector2d(col, row) + offset);
        *ray++ =
            Eigen::Vector2f((px.x() - camera.cx) / camera.fx, (px.y() - camera.cy) / camera.fy);
      }
    }
    for (int span = 0; span < map.spans(); ++span) {
      const int begin = span * RayMap::kSpan;
      const int end = std::min(begin + RayMap::kSpan, map.width);
      map.cones[static_cast<std::size_t>(map.spans()) * row + span] =
          cone_around({first + per_pixel * begin, first + per_pixel * end});
    }
  });
  return map;
}

cv::Mat render(const Scene& scene, const RayMap& map, const std::vector<Pose>& poses, int threads) {
  const std::vector<Eye> eyes = make_eyes(scene, poses);
  cv::Mat light(map.height, map.width, CV_32FC3);
  in_parallel(map.height, threads, [&](int row) { render_row(scene, map, eyes, row, light); });
  return light;
}

cv::Mat render_lines(
    const Scene& scene, const RayMap& map, const LinePoses& poses, bool columns, int threads) {
  cv::Mat light(map.height, map.width, CV_32FC3);
  in_parallel(columns ? map.width : map.height, threads, [&](int line) {
    const std::vector<Eye> eyes = make_eyes(scene, poses(line));
    if (!columns) return render_row(scene, map, eyes, line, light);
    for (int row = 0; row < map.height; ++row)
      render_span(scene, map, eyes, {line, row, 1, 1}, light);
  });
  return light;
}

cv::Mat expose(
    const cv::Mat& light, const ImageRecipe& image, double gain, std::uint64_t seed, int threads) {
  cv::Mat soft = light;
  if (image.blur > 0) cv::GaussianBlur(light, soft, {}, image.blur);
  cv::Mat result(light.size(), CV_8UC3);
  const double half_diagonal2 = (std::pow(light.cols, 2) + std::pow(light.rows, 2)) / 4;
  in_parallel(light.rows, threads, [&](int row) {
    Random random(seed, static_cast<std::uint64_t>(row));
    for (int col = 0; col < light.cols; ++col) {
      const double r2 =
          std::pow(col + 0.5 - light.cols / 2.0, 2) + std::pow(row + 0.5 - light.rows / 2.0, 2);
      const double brightness = gain * (1 - 0.22 * r2 / half_diagonal2);
      for (int k = 0; k < 3; ++k) {
        const double noise = image.noise > 0 ? image.noise * random.normal() : 0;
        result.at<cv::Vec3b>(row, col)[k] = cv::saturate_cast<uchar>(
            static_cast<double>(soft.at<cv::Vec3f>(row, col)[k]) * brightness + noise);
      }
    }
  });
  return result;
}

}  // namespace gpo
