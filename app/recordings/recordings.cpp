// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/recordings/recordings.h"

#include "app/recordings/found_camera.h"
#include "app/recordings/known_files.h"
#include "app/recordings/own_files.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress_bar.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/synthesis/synthesized.h"
#include "ui/workbench/session/recent_files.h"

#include <string>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNamesLength = 30;  ///< what leaves the line below 80 columns

bool is_recipe(const fs::path& path) {
  const fs::path extension = path.extension();
  return (extension == ".yaml" || extension == ".yml") && fs::is_regular_file(path);
}

/// Those that are about to be made: "orbit, approach", or their number where that is too long.
std::string names_of_missing(const std::vector<fs::path>& recipes, const fs::path& cache) {
  std::vector<std::string> names;
  for (const fs::path& recipe : recipes) {
    const fs::path folder = synthesized_folder(recipe, cache);
    if (!fs::exists(folder)) names.push_back(folder.filename().string());
  }
  const std::string all = fmt::format("{}", fmt::join(names, ", "));
  return all.size() <= kNamesLength ? all : fmt::format("{} recordings", names.size());
}

/// `told` is called with what is made, frames that are, and of how many; what it throws ends it.
std::vector<fs::path> make_recordings(const std::vector<fs::path>& recipes, const Progress& told) {
  if (recipes.empty()) return {};
  const fs::path cache = made_recordings_folder();
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  const std::string title = "synthesizing " + names_of_missing(recipes, cache);
  return synthesized_recordings(
      recipes, cache, threads, [&](int done, int of) { told(title, done, of); });
}

/// On standard error; Ctrl-C ends it.
std::vector<fs::path> make_recordings(const std::vector<fs::path>& recipes) {
  if (recipes.empty()) return {};
  const Interrupt interrupt;
  const auto check = [&] { interrupt.check("of what was being synthesized nothing is left"); };
  std::optional<ProgressBar> bar;
  auto made = make_recordings(recipes, [&](const std::string& title, int done, int of) {
    if (!bar) bar.emplace(title);
    bar->show(done, of);
    check();
  });
  check();
  return made;
}

Worker::Opened opened_for_window(const std::shared_ptr<const Recording>& recording) {
  Worker::Opened opened = Worker::with_inspector(recording);
  opened.calibrate = [recording](const std::stop_token& stop, const Progress& progress) {
    const auto calibrated = self_calibrated(*recording, stop, progress);
    return calibrated ? opened_for_window(calibrated) : Worker::Opened{};
  };
  return opened;
}

}  // namespace

std::vector<fs::path> resolve_recordings(const std::vector<fs::path>& paths) {
  std::vector<fs::path> recipes;
  for (const fs::path& path : paths) {
    refuse_known_file(path);
    if (is_recipe(path)) recipes.push_back(path);
  }
  const std::vector<fs::path> made = make_recordings(recipes);
  auto next = made.begin();
  std::vector<fs::path> resolved = paths;
  for (fs::path& path : resolved) {
    if (is_recipe(path)) path = *next++;
  }
  return resolved;
}

namespace {

/// `folder` is what is read, `path` what the user gave.
std::shared_ptr<const Recording> open_resolved(const fs::path& path,
                                               const fs::path& folder,
                                               const OpenOptions& options,
                                               bool calibrates) {
  OpenOptions with_cache = options;
  with_cache.cache_folder = user_cache_folder();
  Recording recording = *open_recording(folder, with_cache);
  recording.path = path;
  if (recording.camera_source == CameraSource::guess) use_found_camera(recording, calibrates);
  return std::make_shared<const Recording>(std::move(recording));
}

/// A recipe's recording is made in the background: whoever waits sees how far it is.
fs::path folder_for_window(const fs::path& path,
                           const std::stop_token& stop,
                           const Progress& progress) {
  refuse_known_file(path);
  if (!is_recipe(path)) return path;
  const auto tell = [&](const std::string& title, int done, int of) {
    if (stop.stop_requested()) throw Interrupted("nothing is left of what was being synthesized");
    progress(title, done, of);
  };
  return make_recordings({path}, tell).front();
}

}  // namespace

std::shared_ptr<const Recording> open_given(const fs::path& path,
                                            const OpenOptions& options,
                                            bool calibrates) {
  return open_resolved(path, resolve_recordings({path}).front(), options, calibrates);
}

Worker::Open opener_for_window(std::size_t cache_mib,
                               const std::optional<fs::path>& recording,
                               const TopicChoices& topics) {
  return [=](const fs::path& path, const std::stop_token& stop, const Progress& progress) {
    OpenOptions options{.tracks = {}, .cache_bytes = cache_mib << 20};
    if (path == recording) options.topics = topics;
    const fs::path folder = folder_for_window(path, stop, progress);
    return opened_for_window(open_resolved(path, folder, options, false));
  };
}

}  // namespace gpo
