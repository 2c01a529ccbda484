// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <map>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// A recipe that renders in a moment: 160x120, 4 frames, one thing of each sort on a small desk.
std::string small_recipe_text();

/// `small_recipe_text` with the first occurrence of `from` replaced.
std::string small_recipe_with(const std::string& from, const std::string& to);

/// The recording of sequences/companions/corner.yaml with a quarter of its pixels and two thirds of
/// its frames, and with `readout_s`. Rendered once.
std::filesystem::path small_room(double readout_s = 0);

/// An empty folder of the running test.
std::filesystem::path test_folder(const std::string& name);

/// Relative path -> bytes of every file below the folder.
std::map<std::string, std::string> folder_contents(const std::filesystem::path& folder);

/// Reads the text as a recipe small.yaml.
Recipe recipe_of(const std::string& text);

Pose camera_of(const Recipe& recipe, int frame);

/// Corners detected near their projections, minus these [px]; an error for projections near the
/// edge.
std::vector<Eigen::Vector2d> corner_errors(const cv::Mat& image,
                                           const std::vector<Eigen::Vector2d>& projections,
                                           int half_window);

/// Expects the board's corners in an image where the camera projects them, within limits [px].
void expect_board(const Recipe& recipe,
                  const Pose& pose,
                  const cv::Mat& image,
                  double most_rms = 0.05,
                  double most_mean = 0.015);

}  // namespace gpo
