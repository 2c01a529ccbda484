// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <filesystem>
#include <map>
#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// A recipe that takes a moment: 160x120, 4 frames, one of each sort of thing on a small desk.
std::string small_recipe_text();

/// `small_recipe_text` with the first occurrence of `from` replaced.
std::string small_recipe_with(const std::string& from, const std::string& to);

/// The recording of sequences/companions/corner.yaml in a quarter of its pixels and two thirds of
/// its frames, whose rows are read within `readout_s`. It is rendered once.
std::filesystem::path small_room(double readout_s = 0);

/// An empty folder of one test's own.
std::filesystem::path test_folder(const std::string& name);

/// Relative path -> bytes of every file below the folder.
std::map<std::string, std::string> folder_contents(const std::filesystem::path& folder);

/// Writes the text to a file in a folder of its own and reads it as a recipe.
Recipe recipe_of(const std::string& text);

/// How far the board's corners found in a picture are from their projections [px].
struct CornerError {
  double mean = 0;  ///< length of the mean vector
  double rms = 0;
};
CornerError corner_error(const Recipe& recipe, const Pose& pose, const cv::Mat& image);

}  // namespace gpo
