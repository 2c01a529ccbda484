// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace gpo {

/// A file without a place on the disk, for libraries that read by a file's name only.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view content = {});
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// While this object lives, in this process.
  std::string path() const;

 private:
  int descriptor_;
};

}  // namespace gpo
