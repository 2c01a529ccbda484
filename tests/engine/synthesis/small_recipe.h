// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <filesystem>
#include <string>

namespace gpo {

/// A recipe that takes a moment: 160x120, 4 frames, one of each sort of thing on a small desk.
std::string small_recipe_text();

/// `small_recipe_text` with the first occurrence of `from` replaced.
std::string small_recipe_with(const std::string& from, const std::string& to);

/// An empty folder of one test's own.
std::filesystem::path test_folder(const std::string& name);

/// Writes the text to a file in a folder of its own and reads it as a recipe.
Recipe recipe_of(const std::string& text);

}  // namespace gpo
