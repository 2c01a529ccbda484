// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/renderer.h"

#include "engine/base/parallel.h"
#include "engine/synthesis/random.h"

#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr float kBoardWhite[3] = {232, 237, 239};
constexpr float kBoardBlack[3] = {38, 36, 36};
constexpr double kFloorHeight = -0.73;  ///< [m]

/// A box as one camera pose sees it.
struct SeenBox {
  Eigen::Vector3d eye;  ///< in the box' axes
  Eigen::Matrix3d R_box_c;
  Eigen::Vector3d middle_c;  ///< center of the sphere around the box, in camera axes
  double gap2;               ///< squared length of a tangent from the eye to that sphere
};

/// A camera pose with what all its rays share.
struct Eye {
  Pose pose;
  std::vector<SeenBox> boxes;
};

Eye make_eye(const Scene& scene, const Pose& pose) {
  Eye eye{pose, {}};
  for (const SceneBox& box : scene.boxes) {
    const Eigen::Vector3d middle_c =
        to_camera(pose, box.origin + Eigen::Vector3d(0, 0, box.size.z() / 2));
    eye.boxes.push_back({box.R_box_world * (pose.p_wc - box.origin),
                         box.R_box_world * pose.R_wc,
                         middle_c,
                         middle_c.squaredNorm() - box.size.squaredNorm() / 4});
  }
  return eye;
}

/// Distance along the ray to the box (slabs), infinite for a miss, and the axis of the face hit.
struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  int axis = 0;
};
Hit hit_box(const SceneBox& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d low(-box.size.x() / 2, -box.size.y() / 2, 0);
  const Eigen::Vector3d high(box.size.x() / 2, box.size.y() / 2, box.size.z());
  Hit hit{0, 0};
  double leave = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double a = (low[k] - origin[k]) / ray[k];
    const double b = (high[k] - origin[k]) / ray[k];
    if (std::min(a, b) > hit.distance) hit = {std::min(a, b), k};
    leave = std::min(leave, std::max(a, b));
  }
  if (!(hit.distance > 0 && hit.distance <= leave)) return {};
  return hit;
}

cv::Vec3f box_color(const SceneBox& box,
                    const Hit& hit,
                    const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& ray) {
  const Eigen::Vector3d p = (origin + hit.distance * ray).cwiseQuotient(box.size);
  if (hit.axis == 2) return sample_texture(box.top, p.x() + 0.5, 0.5 - p.y());
  if (hit.axis == 0) {
    return ray.x() < 0 ? sample_texture(box.sides[1], p.y() + 0.5, 1 - p.z())
                       : sample_texture(box.sides[3], 0.5 - p.y(), 1 - p.z());
  }
  return ray.y() > 0 ? sample_texture(box.sides[0], p.x() + 0.5, 1 - p.z())
                     : sample_texture(box.sides[2], 0.5 - p.x(), 1 - p.z());
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

cv::Vec3f trace(const Scene& scene, const Eye& eye, const Eigen::Vector2f& slope) {
  if (!std::isfinite(slope.x())) return {0, 0, 0};
  const Eigen::Vector3d ray_c(slope.x(), slope.y(), 1);
  const double ray2 = ray_c.squaredNorm();
  Hit nearest;
  std::size_t which = 0;
  for (std::size_t i = 0; i < eye.boxes.size(); ++i) {
    const SeenBox& box = eye.boxes[i];
    const double along = box.middle_c.dot(ray_c);
    if (box.gap2 > 0 && (along < 0 || along * along < box.gap2 * ray2)) continue;
    const Hit hit = hit_box(scene.boxes[i], box.eye, box.R_box_c * ray_c);
    if (hit.distance < nearest.distance) {
      nearest = hit;
      which = i;
    }
  }
  const Eigen::Vector3d ray = eye.pose.R_wc * ray_c;
  const double to_desk = -eye.pose.p_wc.z() / ray.z();
  const double x = eye.pose.p_wc.x() + to_desk * ray.x();
  const double y = eye.pose.p_wc.y() + to_desk * ray.y();
  const bool on_desk =
      to_desk > 0 && std::abs(x) < scene.desk_size.x() / 2 && std::abs(y) < scene.desk_size.y() / 2;
  if (std::isfinite(nearest.distance) && !(on_desk && to_desk < nearest.distance)) {
    const SeenBox& box = eye.boxes[which];
    return box_color(scene.boxes[which], nearest, box.eye, box.R_box_c * ray_c);
  }
  return on_desk ? desk_color(scene, x, y) : room_color(eye.pose.p_wc, ray);
}

std::vector<Eye> make_eyes(const Scene& scene, const std::vector<Pose>& poses) {
  std::vector<Eye> eyes;
  eyes.reserve(poses.size());
  for (const Pose& pose : poses) eyes.push_back(make_eye(scene, pose));
  return eyes;
}

void render_row(
    const Scene& scene, const RayMap& map, const std::vector<Eye>& eyes, int row, cv::Mat& light) {
  const std::size_t per_pixel = static_cast<std::size_t>(map.samples) * map.samples;
  const auto* ray = map.rays.data() + per_pixel * map.width * row;
  for (int col = 0; col < map.width; ++col) {
    cv::Vec3f sum(0, 0, 0);
    for (std::size_t k = 0; k < per_pixel; ++k) {
      // 23 has no factor in common with any number of samples: each pose gets its sample, and a
      // sample's time has little to do with its place in the pixel.
      sum += trace(scene, eyes[(k * 23) % eyes.size()], *ray++);
    }
    light.at<cv::Vec3f>(row, col) = sum / static_cast<float>(per_pixel);
  }
}

}  // namespace

RayMap make_ray_map(const Camera& camera, int samples, int threads) {
  RayMap map{camera.width, camera.height, samples, {}};
  const std::size_t per_pixel = static_cast<std::size_t>(samples) * samples;
  map.rays.resize(per_pixel * camera.width * camera.height);
  in_parallel(camera.height, threads, [&](int row) {
    auto* ray = map.rays.data() + per_pixel * camera.width * row;
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
               const PictureRecipe& picture,
               double gain,
               std::uint64_t seed,
               int threads) {
  cv::Mat soft = light;
  if (picture.blur > 0) cv::GaussianBlur(light, soft, {}, picture.blur);
  cv::Mat result(light.size(), CV_8UC3);
  const double half_diagonal2 = (std::pow(light.cols, 2) + std::pow(light.rows, 2)) / 4;
  in_parallel(light.rows, threads, [&](int row) {
    Random random(seed, static_cast<std::uint64_t>(row));
    for (int col = 0; col < light.cols; ++col) {
      const double r2 =
          std::pow(col + 0.5 - light.cols / 2.0, 2) + std::pow(row + 0.5 - light.rows / 2.0, 2);
      const double brightness = gain * (1 - 0.22 * r2 / half_diagonal2);
      for (int k = 0; k < 3; ++k) {
        const double noise = picture.noise > 0 ? picture.noise * random.normal() : 0;
        result.at<cv::Vec3b>(row, col)[k] = cv::saturate_cast<uchar>(
            static_cast<double>(soft.at<cv::Vec3f>(row, col)[k]) * brightness + noise);
      }
    }
  });
  return result;
}

}  // namespace gpo
