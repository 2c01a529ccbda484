// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// A rock: an ellipsoid with pieces cut off. In its own axes it is the unit sphere.
struct SceneRock {
  struct Cut {
    Eigen::Vector3d normal;  ///< unit vector out of the rock
    double distance;         ///< what lies farther along the normal is cut off
  };
  Eigen::Vector3d center;        ///< in the world [m]
  Eigen::Matrix3d R_unit_world;  ///< world to the rock's axes, divided by its semi-axes
  double reach = 0;              ///< longest semi-axis [m]
  std::vector<Cut> cuts;         ///< in the rock's axes
  cv::Vec3f tint = {1, 1, 1};    ///< of the stone
  double grain = 1;              ///< part of the block of stone that it was cut from, 0 .. 1
};

/// A block of stone to cut rocks from: CV_8UC1, a cube of brightness.
cv::Mat make_stone(int threads);

/// Adds a heap's rocks.
void pile_rocks(std::vector<SceneRock>& rocks, const RubbleRecipe& heap);

/// Brightness of the block, interpolated, at a place in [-1, 1]^3.
float sample_stone(const cv::Mat& stone, const Eigen::Vector3d& place);

}  // namespace gpo
