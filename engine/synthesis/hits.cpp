// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/hits.h"

#include "engine/synthesis/rubble.h"

#include <algorithm>
#include <cmath>

namespace gpo {

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
