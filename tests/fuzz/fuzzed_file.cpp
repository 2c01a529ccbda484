// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzzed_file.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace gpo::fuzz {
namespace {

constexpr std::size_t kLongestMessage = 2000;

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7F; }

}  // namespace

std::filesystem::path file_of(std::string_view bytes) {
  static const int kDescriptor = memfd_create("fuzzed", MFD_CLOEXEC);
  const bool written =
      ftruncate(kDescriptor, 0) == 0 &&
      pwrite(kDescriptor, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  if (!written) std::abort();
  return "/proc/self/fd/" + std::to_string(kDescriptor);
}

void parse(const std::function<void()>& parser) {
  try {
    parser();
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    if (message.size() <= kLongestMessage && std::ranges::none_of(message, is_control)) return;
    throw std::runtime_error(std::string("not a line to print: ") + error.what());
  }
}

}  // namespace gpo::fuzz
