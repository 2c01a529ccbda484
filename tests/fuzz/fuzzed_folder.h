// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/fuzz/fuzzed_file.h"

#include <string>
#include <vector>

namespace gpo::fuzz {

/// A folder of files in the temporary folder, one at a time in a process. The bytes are all files
/// one after the other, each begun by a line "=== NAME"; names that are not among `names` begin
/// none.
class Folder {
 public:
  Folder(std::string_view bytes, const std::vector<std::string>& names);
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace gpo::fuzz
