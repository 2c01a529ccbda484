// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/renderer.h"

#include "engine/base/parallel.h"
#include "engine/synthesis/random.h"
#include "engine/synthesis/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr float kBoardWhite[3] = {232, 237, 239};
constexpr float kBoardBlack[3] = {38, 36, 36};
constexpr double kFloorHeight = -0.73;  ///< [m]

bool overlap(const Cone& a, const Cone& b) {
  return a.axis.dot(b.axis) >= a.cosine * b.cosine - a.sine * b.sine;
}

/// A thing as one camera pose sees it, in the thing's own axes.
struct Seen {
  Eigen::Vector3d eye;
  Eigen::Matrix3d R_own_c;
  std::optional<Cone> cone;  ///< around the sphere around it; none for an eye in that sphere

  Ray ray(const Eigen::Vector3d& ray_c) const { return {eye, R_own_c * ray_c}; }
};

/// A camera pose with what all its rays share.
struct Eye {
  Pose pose;
  std::vector<Seen> boxes;
  std::vector<Seen> rocks;
};

/// What rays of one eye through a part of the picture may meet: places in its lists.
struct Candidates {
  std::vector<std::size_t> boxes;
  std::vector<std::size_t> rocks;
};

Eye make_eye(const Scene& scene, const Pose& pose) {
  Eye eye{pose, {}, {}};
  const auto seen = [&](const Eigen::Matrix3d& R_own_world,
                        const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& middle,
                        double radius2) {
    Seen thing{R_own_world * (pose.p_wc - origin), R_own_world * pose.R_wc, {}};
    const Eigen::Vector3d middle_c = to_camera(pose, middle);
    const double sine2 = radius2 / middle_c.squaredNorm();
    if (sine2 < 1) thing.cone = {middle_c.normalized(), std::sqrt(1 - sine2), std::sqrt(sine2)};
    return thing;
  };
  for (const SceneBox& box : scene.boxes) {
    const Eigen::Vector3d middle = box.origin + Eigen::Vector3d(0, 0, box.size.z() / 2);
    eye.boxes.push_back(seen(box.R_box_world, box.origin, middle, box.size.squaredNorm() / 4));
  }
  for (const SceneRock& rock : scene.rocks) {
    eye.rocks.push_back(seen(rock.R_unit_world, rock.center, rock.center, rock.reach * rock.reach));
  }
  return eye;
}

/// Nothing beside the squares; their colors are computed, so that corners are exact.
const float* board_color(const BoardRecipe& board,
                         const Eigen::Matrix3d& turn,
                         double x,
                         double y) {
  const double dx = x - board.center.x();
  const double dy = y - board.center.y();
  const double u = turn(0, 0) * dx + turn(0, 1) * dy;
  const double v = turn(1, 0) * dx + turn(1, 1) * dy;
  const double column = u / board.square + (board.columns + 1) / 2.0;
  const double row = v / board.square + (board.rows + 1) / 2.0;
  if (column < 0 || row < 0 || column >= board.columns + 1 || row >= board.rows + 1) return nullptr;
  const bool black = (static_cast<int>(column) + static_cast<int>(row)) % 2 == 0;
  return black ? kBoardBlack : kBoardWhite;
}

cv::Vec3f desk_color(const Scene& scene, double x, double y) {
  const double u = x / scene.desk_size.x() + 0.5;
  const double v = 0.5 - y / scene.desk_size.y();
  if (scene.board) {
    if (const float* color = board_color(*scene.board, scene.R_board_world, x, y)) {
      const float light = sample_texture(scene.light, u, v)[0];
      return {color[0] * light, color[1] * light, color[2] * light};
    }
  }
  return sample_texture(scene.desk, u, v);
}

/// A dim room beyond the desk, without texture: a floor below, a wall above.
cv::Vec3f room_color(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  const double level = ray.z() / ray.norm();
  const cv::Vec3f wall(96, 100, 104);
  if (level >= 0) return wall;
  const double distance = (kFloorHeight - origin.z()) / level;
  return wall + (cv::Vec3f(58, 62, 72) - wall) * static_cast<float>(std::exp(-distance / 3));
}

/// The nearest of the things of one sort, and where it is hit.
template <typename Hit>
struct Nearest {
  Hit hit;
  std::size_t which = 0;
};
template <typename Thing, typename Hit>
Nearest<Hit> nearest_of(const std::vector<Thing>& things,
                        const std::vector<Seen>& seen,
                        const std::vector<std::size_t>& candidates,
                        Hit (*hit_thing)(const Thing&, const Ray&, double farthest),
                        const Eigen::Vector3d& ray_c) {
  Nearest<Hit> nearest;
  for (const std::size_t i : candidates) {
    const Hit hit = hit_thing(things[i], seen[i].ray(ray_c), nearest.hit.t);
    if (hit.t < nearest.hit.t) nearest = {hit, i};
  }
  return nearest;
}

Nearest<WallHit> nearest_wall(const std::vector<SceneWall>& walls, const Ray& ray) {
  Nearest<WallHit> nearest;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const WallHit hit = hit_wall(walls[i], ray);
    if (hit.t < nearest.hit.t) nearest = {hit, i};
  }
  return nearest;
}

cv::Vec3f trace(const Scene& scene,
                const Eye& eye,
                const Candidates& candidates,
                const Eigen::Vector2f& slope) {
  if (!std::isfinite(slope.x())) return {0, 0, 0};
  const Eigen::Vector3d ray_c(slope.x(), slope.y(), 1);
  const Ray ray{eye.pose.p_wc, eye.pose.R_wc * ray_c};
  const auto box = nearest_of(scene.boxes, eye.boxes, candidates.boxes, hit_box, ray_c);
  const auto rock = nearest_of(scene.rocks, eye.rocks, candidates.rocks, hit_rock, ray_c);
  const auto wall = nearest_wall(scene.walls, ray);
  const double to_desk = -ray.origin.z() / ray.along.z();
  const double x = ray.origin.x() + to_desk * ray.along.x();
  const double y = ray.origin.y() + to_desk * ray.along.y();
  const bool on_desk =
      to_desk > 0 && std::abs(x) < scene.desk_size.x() / 2 && std::abs(y) < scene.desk_size.y() / 2;
  const double desk_t = on_desk ? to_desk : std::numeric_limits<double>::infinity();
  const double t = std::min({box.hit.t, rock.hit.t, wall.hit.t, desk_t});
  if (!std::isfinite(t)) return room_color(ray.origin, ray.along);
  if (t == box.hit.t) {
    return box_color(scene.boxes[box.which], box.hit, eye.boxes[box.which].ray(ray_c));
  }
  if (t == rock.hit.t) {
    const Ray own = eye.rocks[rock.which].ray(ray_c);
    return rock_color(scene.rocks[rock.which], scene.stone, rock.hit, own);
  }
  if (t == wall.hit.t) {
    return sample_texture(scene.walls[wall.which].texture, wall.hit.u, wall.hit.v);
  }
  return desk_color(scene, x, y);
}

std::vector<Eye> make_eyes(const Scene& scene, const std::vector<Pose>& poses) {
  std::vector<Eye> eyes;
  eyes.reserve(poses.size());
  for (const Pose& pose : poses) eyes.push_back(make_eye(scene, pose));
  return eyes;
}

Eigen::Vector3d direction(const Eigen::Vector2f& slope) {
  return Eigen::Vector3d(slope.x(), slope.y(), 1).normalized();
}

/// Around all rays; nothing where the lens sees nothing.
std::optional<Cone> cone_around(std::span<const Eigen::Vector2f> slopes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& slope : slopes) {
    if (std::isfinite(slope.x())) sum += direction(slope);
  }
  if (sum.isZero()) return std::nullopt;
  const Eigen::Vector3d axis = sum.normalized();
  double cosine = 1;
  for (const auto& slope : slopes) {
    if (std::isfinite(slope.x())) cosine = std::min(cosine, axis.dot(direction(slope)));
  }
  cosine -= 1e-9;  // rounding must not lose a thing that is just touched
  return Cone{axis, cosine, std::sqrt(1 - cosine * cosine)};
}

std::vector<std::size_t> within(const Cone& cone, const std::vector<Seen>& things) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (!things[i].cone || overlap(cone, *things[i].cone)) found.push_back(i);
  }
  return found;
}

/// For each eye.
std::vector<Candidates> find_candidates(const std::vector<Eye>& eyes,
                                        const std::optional<Cone>& cone) {
  std::vector<Candidates> candidates(eyes.size());
  for (std::size_t i = 0; cone && i < eyes.size(); ++i) {
    candidates[i] = {within(*cone, eyes[i].boxes), within(*cone, eyes[i].rocks)};
  }
  return candidates;
}

void render_row(
    const Scene& scene, const RayMap& map, const std::vector<Eye>& eyes, int row, cv::Mat& light) {
  const std::size_t per_pixel = static_cast<std::size_t>(map.samples) * map.samples;
  const auto* ray = map.rays.data() + per_pixel * map.width * row;
  const auto* cone = map.cones.data() + static_cast<std::size_t>(map.spans()) * row;
  std::vector<Candidates> candidates;
  for (int col = 0; col < map.width; ++col) {
    if (col % RayMap::kSpan == 0) candidates = find_candidates(eyes, *cone++);
    cv::Vec3f sum(0, 0, 0);
    for (std::size_t k = 0; k < per_pixel; ++k) {
      // 23 has no factor in common with any number of samples: each pose gets its sample, and a
      // sample's time has little to do with its place in the pixel.
      const std::size_t time = (k * 23) % eyes.size();
      sum += trace(scene, eyes[time], candidates[time], *ray++);
    }
    light.at<cv::Vec3f>(row, col) = sum / static_cast<float>(per_pixel);
  }
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

cv::Mat render(const Scene& scene, const RayMap& map, const RowPoses& row_poses, int threads) {
  cv::Mat light(map.height, map.width, CV_32FC3);
  in_parallel(map.height, threads, [&](int row) {
    render_row(scene, map, make_eyes(scene, row_poses(row)), row, light);
  });
  return light;
}

cv::Mat expose(const cv::Mat& light,
               const ImageRecipe& image,
               double gain,
               std::uint64_t seed,
               int threads) {
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
