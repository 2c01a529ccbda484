// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <array>
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

/// What there is to see, painted once; textures are CV_8UC3 and much finer than a picture.
struct Scene {
  Eigen::Vector2d desk_size;         ///< [m]
  cv::Mat desk;                      ///< seen from above, +y at the picture's top, light included
  cv::Mat light;                     ///< CV_32FC1, coarse: lamp and shadows on the desk
  std::optional<BoardRecipe> board;  ///< its squares are not painted but computed, exactly
  Eigen::Matrix3d R_board_world = Eigen::Matrix3d::Identity();
  std::vector<SceneBox> boxes;
};

Scene make_scene(const DeskRecipe& desk, int threads);

/// Interpolated texture at the fraction (u, v) of its width and height, v downwards.
cv::Vec3f sample_texture(const cv::Mat& texture, double u, double v);

}  // namespace gpo
