// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"
#include "engine/synthesis/rubble.h"

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// A box ready to be hit by rays. Its own axes: origin at the center of its bottom, z up.
struct SceneBox {
  Eigen::Vector3d origin;  ///< in the world [m]
  Eigen::Vector3d size;    ///< [m]
  Eigen::Matrix3d R_box_world;
  std::array<cv::Mat, 4> sides;  ///< CV_8UC3: front (-y), right (+x), back (+y), left (-x)
  cv::Mat top;                   ///< CV_8UC3
};

/// A wall ready to be hit by rays, from both sides.
struct SceneWall {
  Eigen::Vector3d foot;   ///< its lower corner on the left, in the world [m]
  Eigen::Vector3d along;  ///< unit vector from there along the floor
  Eigen::Vector2d size;   ///< length, height [m]
  cv::Mat texture;        ///< CV_8UC3, light included
};

/// What there is to see, painted once; textures are CV_8UC3 and much finer than a picture.
struct Scene {
  Eigen::Vector2d desk_size = Eigen::Vector2d::Zero();  ///< [m]; zero: there is no desk
  cv::Mat desk;                      ///< seen from above, +y at the picture's top, light included
  cv::Mat light;                     ///< CV_32FC1, coarse: lamp and shadows on the desk
  std::optional<BoardRecipe> board;  ///< its squares are not painted but computed, exactly
  Eigen::Matrix3d R_board_world = Eigen::Matrix3d::Identity();
  std::vector<SceneBox> boxes;
  std::vector<SceneWall> walls;
  std::vector<SceneRock> rocks;
  cv::Mat stone;  ///< CV_8UC1 of three dimensions: the brightness of a block of stone
};

/// Painting takes seconds: `step` is called after each part of it, and stops it where it throws.
Scene make_scene(
    const DeskRecipe& desk, int threads, const std::function<void()>& step = [] {});
/// With its rubble.
Scene make_scene(
    const Recipe& recipe, int threads, const std::function<void()>& step = [] {});

/// Interpolated texture, CV_8UC3 or CV_32FC1, at the fraction (u, v) of its width and height, v
/// downwards.
cv::Vec3f sample_texture(const cv::Mat& texture, double u, double v);

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
