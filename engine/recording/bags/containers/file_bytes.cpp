// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/file_bytes.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gpo {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw InputError(path.string() + ": cannot be read: " + std::generic_category().message(errno));
}

}  // namespace

// Without O_NONBLOCK opening a pipe would wait for who writes to it.
FileBytes::FileBytes(const std::filesystem::path& path)
    : path_(path), descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) fail(path);
  struct stat about {};
  const bool known = fstat(descriptor_, &about) == 0;
  if (known && S_ISREG(about.st_mode)) {
    size_ = static_cast<std::uint64_t>(about.st_size);
    // Opening jumps from message to message: what lies between is not wanted.
    posix_fadvise(descriptor_, 0, 0, POSIX_FADV_RANDOM);
    return;
  }
  close(descriptor_);
  if (!known) fail(path);
  throw InputError(path.string() + ": found no regular file, expected a bag");
}

FileBytes::~FileBytes() { close(descriptor_); }

std::string FileBytes::read(std::uint64_t place, std::uint64_t count) const {
  if (place >= size_) return {};
  std::string bytes(std::min(count, size_ - place), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = pread(
        descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(place + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path_);
    if (got == 0) break;  // it has become shorter
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

std::string cut_note(const FileBytes& file, std::uint64_t place) {
  return fmt::format(
      "the bag is cut or broken in what begins at byte {} of {}: it is read up to there",
      place,
      file.size());
}

}  // namespace gpo
