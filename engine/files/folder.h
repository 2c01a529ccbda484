// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace gpo {

/// Returns false also on errors, such as a loop of links or a folder without permission.
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);

std::optional<std::filesystem::path> if_file(const std::filesystem::path& path);

/// Returns the folder of a file, "." if its path has none.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Returns the files of a folder, unsorted. Throws InputError if it cannot be read.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

}  // namespace gpo
