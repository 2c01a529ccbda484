// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace gpo {

/// False also for what cannot be looked at: a loop of links, a folder that may not be entered.
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);

std::optional<std::filesystem::path> if_file(const std::filesystem::path& path);

/// The folder that holds a file: "." where its path names none.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// All files of a folder, in no order. Throws InputError where it cannot be read.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

}  // namespace gpo
