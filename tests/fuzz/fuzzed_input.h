// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace gpo::fuzz {

/// Returns a file in memory that contains these bytes until the next call.
std::filesystem::path file_of(std::string_view bytes);

/// A folder of files in the temporary folder, one at a time in a process. The bytes are the files
/// one after the other, each after a line "=== NAME" with one of `names`.
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

/// Calls a parser, which may refuse its input by an InputError with one printable line. libFuzzer
/// takes any other exception for a crash.
void parse(const std::function<void()>& parser);

}  // namespace gpo::fuzz
