// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/synthesized.h"

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <mutex>
#include <stdexcept>
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

/// Holds a folder against other threads and processes that lock it, too; the system lets go of what
/// a killed process held. Makes the folder, and takes it away at the end where it is still empty.
class FolderLock {
 public:
  /// Waits. Throws InputError where the folder cannot be made or locked.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

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

constexpr int kFormat = 1;  ///< counts up when the same recipe makes other bytes

struct Missing {
  fs::path folder;
  Recipe recipe;
};

/// Each once, however often it is asked for.
std::vector<Missing> missing_recordings(std::span<const fs::path> recipes,
                                        const std::vector<fs::path>& folders) {
  std::vector<Missing> missing;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    if (fs::exists(folders[i])) continue;
    if (std::ranges::find(missing, folders[i], &Missing::folder) != missing.end()) continue;
    missing.push_back({folders[i], read_recipe(recipes[i])});
  }
  return missing;
}

/// What the threads that make recordings share; guarded by the mutex.
struct Common {
  const SynthesisProgress& progress;
  int frames = 0;
  int done = 0;
  std::exception_ptr error = nullptr;  ///< the first one; it stops everybody
  std::mutex mutex{};
};

void report(Common& common, int more_frames) {
  const std::lock_guard lock(common.mutex);
  if (common.error) throw std::runtime_error("another recording failed");
  common.done += more_frames;
  try {
    if (common.progress) common.progress(common.done, common.frames);
  } catch (...) {
    common.error = std::current_exception();  // before any other gets on with its own
    throw;
  }
}

void make(const Missing& missing, Common& common, int threads) {
  int done = 0;
  const auto progress = [&](int now, int) { report(common, now - std::exchange(done, now)); };
  const FolderLock lock(missing.folder.parent_path());
  report(common, 0);
  if (fs::exists(missing.folder)) return progress(missing.recipe.frame_count, 0);
  synthesize(missing.recipe, missing.folder, progress, threads);
}

void make_all(const std::vector<Missing>& missing, int threads, const SynthesisProgress& progress) {
  const int count = static_cast<int>(missing.size());
  const int at_a_time = std::max(1, std::min(count, threads));
  Common common{progress};
  for (const Missing& one : missing) common.frames += one.recipe.frame_count;
  in_parallel(count, at_a_time, [&](int i) {
    try {
      make(missing[static_cast<std::size_t>(i)], common, threads / at_a_time);
    } catch (...) {
      const std::lock_guard lock(common.mutex);
      if (!common.error) common.error = std::current_exception();
    }
  });
  if (common.error) std::rethrow_exception(common.error);
}

}  // namespace

fs::path synthesized_folder(const fs::path& recipe, const fs::path& cache) {
  const std::string stem = recipe.stem().string();
  const std::uint64_t key =
      fnv1a(fmt::format("{} {}", kFormat, read_file(recipe, kMostBytesByHand)));
  return cache / fmt::format("{}-{:016x}", stem, key) / stem;
}

std::vector<fs::path> synthesized_recordings(std::span<const fs::path> recipes,
                                             const fs::path& cache,
                                             int threads,
                                             const SynthesisProgress& progress) {
  std::vector<fs::path> folders;
  folders.reserve(recipes.size());
  for (const fs::path& recipe : recipes) folders.push_back(synthesized_folder(recipe, cache));
  make_all(missing_recordings(recipes, folders), threads, progress);
  return folders;
}

}  // namespace gpo
