// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/folder_lock.h"

#include "engine/base/error.h"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& folder, const std::error_code& why) {
  throw InputError(fmt::format(
      "{}: cannot be made ({}), expected a folder to write into", folder.string(), why.message()));
}

/// An open and locked descriptor; -1 where the folder went away meanwhile.
int lock(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT) return -1;
  if (descriptor < 0) refuse(folder, {errno, std::generic_category()});
  while (flock(descriptor, LOCK_EX) != 0) {
    if (errno == EINTR) continue;
    const std::error_code why(errno, std::generic_category());
    close(descriptor);
    refuse(folder, why);
  }
  return descriptor;
}

/// Who held the lock before may have taken the folder away, and another one may be in its place.
bool is_still_there(int descriptor, const fs::path& folder) {
  struct stat held {};
  struct stat named {};
  return fstat(descriptor, &held) == 0 && stat(folder.c_str(), &named) == 0 &&
         held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(fs::path folder) : folder_(std::move(folder)) {
  while (true) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) refuse(folder_, error);
    descriptor_ = lock(folder_);
    if (descriptor_ >= 0 && is_still_there(descriptor_, folder_)) return;
    if (descriptor_ >= 0) close(descriptor_);
  }
}

FolderLock::~FolderLock() {
  std::error_code not_empty;
  fs::remove(folder_, not_empty);
  close(descriptor_);
}

}  // namespace gpo
