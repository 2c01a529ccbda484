// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

// Kinds of files by the endings of their names, in upper or lower case.

bool is_image_name(const std::filesystem::path& file);
bool is_video_name(const std::filesystem::path& file);
bool is_bag_name(const std::filesystem::path& file);
/// "mp4, avi, ...": endings of files that are recordings by themselves.
std::string recording_endings();

/// Returns whether the name ends in "yaml" or "yml" (lower case).
bool is_yaml_name(const std::filesystem::path& file);
/// Returns whether a path is an existing file with the name of a recipe.
bool is_recipe(const std::filesystem::path& path);

/// Returns the files of a folder that `is_kind` accepts, sorted by path. Throws InputError.
std::vector<std::filesystem::path> files_of_kind(
    const std::filesystem::path& folder, bool (*is_kind)(const std::filesystem::path& file));
/// Returns the only file; nullopt if there is none. Throws InputError for several `things`.
std::optional<std::filesystem::path> only_file(const std::vector<std::filesystem::path>& files,
                                               const char* things,
                                               const std::filesystem::path& folder);
}  // namespace gpo
