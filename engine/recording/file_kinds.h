// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace gpo {

// What files are by the endings of their names; the case of letters does not matter.

bool is_image_name(const std::filesystem::path& file);
bool is_video_name(const std::filesystem::path& file);
bool is_bag_name(const std::filesystem::path& file);
/// "mp4, avi, ...": of the files that are recordings by themselves.
std::string recording_endings();

/// "yaml" or "yml", in lower case.
bool is_yaml_name(const std::filesystem::path& file);
/// Whether a path is a recipe by its name, and a file.
bool is_recipe(const std::filesystem::path& path);

}  // namespace gpo
