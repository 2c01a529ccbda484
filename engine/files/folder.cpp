// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/folder.h"

#include "engine/base/error.h"

namespace gpo {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

bool is_folder(const fs::path& path) {
  std::error_code none;
  return fs::is_directory(path, none);
}

std::optional<fs::path> if_file(const fs::path& path) {
  return is_file(path) ? std::optional(path) : std::nullopt;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code none;
    if (entry->is_regular_file(none)) files.push_back(entry->path());
  }
  if (error) throw InputError(folder.string() + ": cannot be read (" + error.message() + ")");
  return files;
}

}  // namespace gpo
