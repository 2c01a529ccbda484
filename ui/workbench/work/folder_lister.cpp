// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/folder_lister.h"

#include "engine/experiment/results_file.h"
#include "engine/recording/layouts/glance.h"
#include "engine/synthesis/recipe.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

std::vector<FolderEntry> entries_of(const fs::path& folder) {
  std::vector<FolderEntry> entries;
  std::error_code none;
  for (const auto& one :
       fs::directory_iterator(folder, fs::directory_options::skip_permission_denied))
    entries.push_back({one.path().filename().string(), one.is_directory(none)});
  std::ranges::sort(entries, [](const FolderEntry& a, const FolderEntry& b) {
    return a.folder != b.folder ? a.folder : a.name < b.name;
  });
  return entries;
}

std::string recipe_description(const fs::path& path) {
  try {
    read_recipe(path);
    return "recipe, rendered when it is opened";
  } catch (const std::exception&) {
    return "";  // a calibration, say
  }
}

/// For people, in a few words; empty where there is nothing to open.
std::string description_of(const fs::path& path) {
  try {
    if (path.extension() == ".json") return is_session(path) ? "session" : "";
    if (path.extension() == ".csv") return is_results(path) ? "results of evaluate" : "";
    if (path.extension() == ".yaml") return recipe_description(path);
    const Glance seen = glance(path);
    if (seen.layout.empty() || seen.frames == 0) return seen.layout;
    return fmt::format(
        "{} \u00b7 {} frames \u00b7 {:.1f} s", seen.layout, seen.frames, seen.seconds);
  } catch (const std::exception&) {
    return "";
  }
}

}  // namespace

FolderLister::FolderLister(std::function<void()> changed)
    : job_([this] { return next(); }, std::move(changed)) {}

FolderList FolderLister::list(const fs::path& folder) {
  const auto lock = job_.lock();
  if (folder != folder_) {
    job_.cancel();
    folder_ = folder;
    wanted_ = true;
    list_ = {{}, "", true};
    job_.wake();
  }
  return list_;
}

void FolderLister::forget() {
  const auto lock = job_.lock();
  job_.cancel();
  folder_.clear();
  wanted_ = false;
}

BackgroundJob::Job FolderLister::next() {
  if (!std::exchange(wanted_, false)) return nullptr;
  return [this, folder = folder_](const std::stop_token& stop) { read(folder, stop); };
}

void FolderLister::read(const fs::path& folder, const std::stop_token& stop) {
  std::vector<FolderEntry> entries;
  std::string error;
  try {
    entries = entries_of(folder);
  } catch (const fs::filesystem_error& failed) {
    error = failed.code().message();
  }
  if (job_.publish(stop, [&] { list_ = {entries, error, true}; })) job_.notify();
  for (std::size_t i = 0; i < entries.size() && !stop.stop_requested(); ++i) {
    const std::string what = description_of(folder / entries[i].name);
    const auto describe = [&] {
      list_.entries[i].what = what;
      list_.entries[i].known = true;
    };
    if (job_.publish(stop, describe)) job_.notify();
  }
  job_.publish(stop, [&] { list_.reading = false; });
}

}  // namespace gpo
