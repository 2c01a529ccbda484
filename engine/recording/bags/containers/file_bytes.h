// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace gpo {

/// A file of which parts are read, by several threads at once.
class FileBytes {
 public:
  /// Throws InputError where it cannot be read, or is no regular file.
  explicit FileBytes(const std::filesystem::path& path);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// So many bytes, fewer where the file ends before. Throws InputError.
  std::string read(std::uint64_t place, std::uint64_t count) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// What people are told of a file that is read up to a place only.
std::string cut_note(const FileBytes& file, std::uint64_t place);

}  // namespace gpo
