// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/scene.h"

#include <limits>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// origin + t along; in whatever axes the thing is described in.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d along;  ///< not a unit vector: t is then the same in all axes
};

/// Where a ray first meets a thing: 0 < t < farthest, infinite for a miss.
struct BoxHit {
  double t = std::numeric_limits<double>::infinity();
  int axis = 0;  ///< across the face that is hit
};
/// In the box' axes.
BoxHit hit_box(const SceneBox& box, const Ray& ray, double farthest);
cv::Vec3f box_color(const SceneBox& box, const BoxHit& hit, const Ray& ray);

struct WallHit {
  double t = std::numeric_limits<double>::infinity();
  double u = 0;  ///< fraction of the wall's length, from its foot
  double v = 0;  ///< fraction of its height, from the top down
};
/// In the world.
WallHit hit_wall(const SceneWall& wall, const Ray& ray);

struct RockHit {
  double t = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< in the rock's axes
};
/// In the rock's axes.
RockHit hit_rock(const SceneRock& rock, const Ray& ray, double farthest);
cv::Vec3f rock_color(const SceneRock& rock,
                     const cv::Mat& stone,
                     const RockHit& hit,
                     const Ray& ray);

}  // namespace gpo
