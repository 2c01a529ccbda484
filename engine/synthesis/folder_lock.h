// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace gpo {

/// Holds a folder against other threads and processes that lock it, too; the system lets go of what
/// a killed process held. Makes the folder, and takes it away at the end where it is still empty.
class FolderLock {
 public:
  /// Waits. Throws InputError where the folder cannot be made or locked.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

}  // namespace gpo
