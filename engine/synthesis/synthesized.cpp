// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/synthesized.h"

#include "engine/base/parallel.h"
#include "engine/files/text_file.h"
#include "engine/synthesis/folder_lock.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;  ///< counts up when the same recipe makes other bytes

/// FNV-1a.
std::uint64_t hash(const std::string& bytes) {
  std::uint64_t sum = 0xcbf29ce484222325ULL;
  for (const char byte : bytes) {
    sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
  }
  return sum;
}

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
      hash(fmt::format("{} {}", kFormat, read_file(recipe, kMostBytesByHand)));
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
