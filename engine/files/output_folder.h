// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace gpo {

/// The one rule of all output folders: refuses what is no folder, and a folder that is not empty,
/// but for one that holds `ours`, the file by which a command knows a folder of its own. Throws
/// InputError.
void check_output_folder(const std::filesystem::path& folder, const std::string& ours = "");

/// A folder that appears whole or not at all: filled under another name beside it, then renamed by
/// `finish`. What is not finished is removed.
class UnfinishedFolder {
 public:
  /// Throws InputError where there is something already that is no empty folder, or where nothing
  /// can be written.
  explicit UnfinishedFolder(const std::filesystem::path& folder);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Throws InputError.
  void finish();

 private:
  std::filesystem::path folder_, path_;
};

}  // namespace gpo
