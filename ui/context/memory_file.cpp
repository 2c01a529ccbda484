// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/memory_file.h"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include <sys/mman.h>
#include <unistd.h>

namespace gpo {

MemoryFile::MemoryFile(std::string_view content)
    : descriptor_(memfd_create("gpo-inspector", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  std::ofstream(path(), std::ios::binary).write(content.data(), std::ssize(content));
}

MemoryFile::~MemoryFile() { close(descriptor_); }

std::string MemoryFile::path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

}  // namespace gpo
