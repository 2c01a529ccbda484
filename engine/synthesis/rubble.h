// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"
#include "engine/synthesis/scene.h"

#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// A block of stone to cut rocks from: CV_8UC1, a cube of brightness.
cv::Mat make_stone(int threads);

/// Adds a heap's rocks.
void pile_rocks(std::vector<SceneRock>& rocks, const RubbleRecipe& heap);

/// Brightness of the block, interpolated, at a place in [-1, 1]^3.
float sample_stone(const cv::Mat& stone, const Eigen::Vector3d& place);

}  // namespace gpo
