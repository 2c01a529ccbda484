// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzzed_input.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <sys/mman.h>
#include <unistd.h>

namespace gpo::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestMessage = 2000;
constexpr std::string_view kMark = "=== ";

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7F; }

}  // namespace

fs::path file_of(std::string_view bytes) {
  static const int kDescriptor = memfd_create("fuzzed", MFD_CLOEXEC);
  const bool written =
      ftruncate(kDescriptor, 0) == 0 &&
      pwrite(kDescriptor, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  if (!written) std::abort();
  return "/proc/self/fd/" + std::to_string(kDescriptor);
}

Folder::Folder(std::string_view bytes, const std::vector<std::string>& names)
    : path_(fs::temp_directory_path() / ("gpo-fuzz-" + std::to_string(getpid()))) {
  fs::create_directories(path_);
  std::ofstream file;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = bytes.substr(0, end);
    const std::string_view whole = bytes.substr(0, end + 1);
    bytes.remove_prefix(whole.size());
    const bool begins = line.starts_with(kMark) &&
                        std::ranges::find(names, line.substr(kMark.size())) != names.end();
    if (!begins) {
      file << whole;
      continue;
    }
    const fs::path name = path_ / line.substr(kMark.size());
    fs::create_directories(name.parent_path());
    file = std::ofstream(name, std::ios::binary);
  }
}

Folder::~Folder() { fs::remove_all(path_); }

void parse(const std::function<void()>& parser) {
  try {
    parser();
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    if (message.size() <= kLongestMessage && std::ranges::none_of(message, is_control)) return;
    throw std::runtime_error(std::string("message is not one printable line: ") + error.what());
  }
}

}  // namespace gpo::fuzz
