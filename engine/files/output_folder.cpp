// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/output_folder.h"

#include "engine/base/error.h"

#include <fmt/format.h>

namespace gpo {

namespace fs = std::filesystem;

void check_output_folder(const fs::path& folder, const std::string& ours) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  bool free = fs::is_directory(folder, error) && fs::is_empty(folder, error);
  // Also while that file is being written, under a name that begins so.
  if (!ours.empty() && fs::is_directory(folder, error))
    for (const auto& entry : fs::directory_iterator(folder, error))
      free = free || entry.path().filename().string().starts_with(ours);
  if (free) return;
  throw InputError(
      fmt::format("{}: found something there already, expected no folder or an empty one{}",
                  folder.string(),
                  ours.empty() ? "" : fmt::format(", or one with {}", ours)));
}

UnfinishedFolder::UnfinishedFolder(const fs::path& folder)
    : folder_(fs::absolute(folder / "").parent_path()), path_(folder_.string() + ".unfinished") {
  check_output_folder(folder);
  std::error_code error;
  fs::remove_all(path_, error);
  fs::create_directories(path_, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be made ({}), expected a folder to write into",
                                 path_.string(),
                                 error.message()));
  }
}

UnfinishedFolder::~UnfinishedFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void UnfinishedFolder::finish() {
  std::error_code error;
  fs::remove(folder_, error);
  if (!error) fs::rename(path_, folder_, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be written ({})", folder_.string(), error.message()));
  }
}

}  // namespace gpo
