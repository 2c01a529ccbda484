// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <functional>

#include <opencv2/core.hpp>

namespace gpo {

/// A box. Its own axes: origin at the center of its bottom, z up.
struct SceneBox {
  Eigen::Vector3d origin;  ///< in the world [m]
  Eigen::Vector3d size;    ///< [m]
  Eigen::Matrix3d R_box_world;
  std::array<cv::Mat, 4> sides;  ///< CV_8UC3: front (-y), right (+x), back (+y), left (-x)
  cv::Mat top;                   ///< CV_8UC3
};

/// A wall, visible from both sides.
struct SceneWall {
  Eigen::Vector3d foot;   ///< its lower left corner in the world [m]
  Eigen::Vector3d along;  ///< unit vector from there along the floor
  Eigen::Vector2d size;   ///< length, height [m]
  cv::Mat texture;        ///< CV_8UC3, light included
};

/// A rock: an ellipsoid with pieces cut off. In its own axes it is the unit sphere.
struct SceneRock {
  struct Cut {
    Eigen::Vector3d normal;  ///< unit vector out of the rock
    double distance;         ///< along the normal, beyond which everything is cut off
  };
  Eigen::Vector3d center;        ///< in the world [m]
  Eigen::Matrix3d R_unit_world;  ///< world to the rock's axes, divided by its semi-axes
  double reach = 0;              ///< longest semi-axis [m]
  std::vector<Cut> cuts;         ///< in the rock's axes
  cv::Vec3f tint = {1, 1, 1};    ///< color of the stone
  double grain = 1;              ///< part of the block of stone that it was cut from, 0 .. 1
};

/// Contents of a scene, painted once; textures are CV_8UC3 and much finer than an image.
struct Scene {
  Eigen::Vector2d desk_size = Eigen::Vector2d::Zero();  ///< [m]; zero without a desk
  cv::Mat desk;                                         ///< from above, +y up, light included
  cv::Mat light;                     ///< CV_32FC1, coarse: lamp and shadows on the desk
  std::optional<BoardRecipe> board;  ///< its squares are computed exactly, not painted
  Eigen::Matrix3d R_board_world = Eigen::Matrix3d::Identity();
  std::vector<SceneBox> boxes;
  std::vector<SceneWall> walls;
  std::vector<SceneRock> rocks;
  cv::Mat stone;  ///< CV_8UC1, three dimensions: brightness of a block of stone
};

/// Paints a scene, with its rubble, which takes seconds.
Scene make_scene(const Recipe& recipe, int threads);

/// Interpolates a texture, CV_8UC3 or CV_32FC1, at the fraction (u, v) of its width and height, v
/// downwards.
cv::Vec3f sample_texture(const cv::Mat& texture, double u, double v);

/// Directions in camera axes within an angle of less than 90 deg from an axis.
struct Cone {
  Eigen::Vector3d axis;  ///< unit vector
  double cosine;         ///< cosine of the angle
  double sine;
};

/// Rays of a camera's image: samples x samples a pixel, on a regular grid around the pixel's
/// center, through the exact lens model. Computed once for all frames.
struct RayMap {
  int width = 0;
  int height = 0;
  int samples = 1;
  /// (x/z, y/z) in camera axes, by pixel and sample; NaN beyond the lens model's valid radius.
  std::vector<Eigen::Vector2f> rays;
  /// Cones around the rays of each span of pixels, row by row, which share candidates; nullopt
  /// beyond the lens model's valid radius.
  static constexpr int kSpan = 16;
  std::vector<std::optional<Cone>> cones;

  int spans() const { return (width + kSpan - 1) / kSpan; }  ///< per row
};
RayMap make_ray_map(const Camera& camera, int samples, int threads);

/// Renders an image before lens blur and noise, CV_32FC3 in gray levels. Sample k of each pixel is
/// seen from poses[k % size]: poses over the exposure make motion blur.
cv::Mat render(const Scene& scene, const RayMap& map, const std::vector<Pose>& poses, int threads);

/// The same with poses for each row, or for each column (rolling shutter).
using LinePoses = std::function<std::vector<Pose>(int line)>;
cv::Mat render_lines(
    const Scene& scene, const RayMap& map, const LinePoses& poses, bool columns, int threads);

/// Adds lens blur, vignette, gain and noise: CV_8UC3. The same for equal seeds and any threads.
cv::Mat expose(
    const cv::Mat& light, const ImageRecipe& image, double gain, std::uint64_t seed, int threads);

}  // namespace gpo
