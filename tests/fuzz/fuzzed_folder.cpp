// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzzed_folder.h"

#include <algorithm>
#include <fstream>

#include <unistd.h>

namespace gpo::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = "=== ";

/// Takes the first line off a text.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

}  // namespace

Folder::Folder(std::string_view bytes, const std::vector<std::string>& names)
    : path_(fs::temp_directory_path() / ("gpo-fuzz-" + std::to_string(getpid()))) {
  fs::create_directories(path_);
  std::ofstream file;
  while (!bytes.empty()) {
    const std::string_view rest = bytes;
    const std::string_view line = take_line(bytes);
    const bool begins = line.starts_with(kMark) &&
                        std::ranges::find(names, line.substr(kMark.size())) != names.end();
    if (!begins) {
      file << rest.substr(0, rest.size() - bytes.size());
      continue;
    }
    const fs::path name = path_ / line.substr(kMark.size());
    fs::create_directories(name.parent_path());
    file = std::ofstream(name, std::ios::binary);
  }
}

Folder::~Folder() { fs::remove_all(path_); }

}  // namespace gpo::fuzz
