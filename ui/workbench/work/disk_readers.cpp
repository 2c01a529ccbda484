// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/disk_readers.h"

#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "engine/files/text_file.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/synthesis/recipe.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Returns the entries without descriptions, or the error.
FolderList list_of(const fs::path& folder) {
  FolderList list{.entries = {}, .error = "", .reading = true};
  std::error_code error, none;
  fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    list.entries.push_back({entry->path().filename().string(), entry->is_directory(none)});
  if (error) list = {{}, error.message(), true};
  std::ranges::sort(
      list.entries, {}, [](const FolderEntry& one) { return std::tuple(!one.folder, one.name); });
  return list;
}

fs::path home() {
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): never set here
  return home != nullptr ? home : "/";
}

/// Returns where the last part "~" begins; nullopt if there is none. A name may begin with "~",
/// too.
std::optional<std::size_t> last_home(const std::string& path) {
  const std::size_t at = path.ends_with("/~") ? path.size() - 2 : path.rfind("/~/");
  return at == std::string::npos ? std::nullopt : std::optional(at + 1);
}

bool begins(const FolderEntry& entry, const std::string& name) {
  return lower_case(entry.name).starts_with(lower_case(name));
}

constexpr std::chrono::milliseconds kLongestProbe{200};

/// A few words for people; empty if it cannot be opened.
std::string description_of(const fs::path& path) {
  try {
    if (path.extension() == ".json") return is_session(path) ? "session" : "";
    if (path.extension() == ".csv") return is_results(path) ? "results of evaluate" : "";
    if (is_recipe(path)) {
      read_recipe(path);  // throws for other files, such as calibrations
      return "recipe, rendered when opened";
    }
    const PathProbe seen = probe_path(path, kLongestProbe);
    if (seen.layout.empty() || seen.frames == 0) return seen.layout;
    return fmt::format("{} \u00b7 {} \u00b7 {:.1f} s",
                       seen.layout,
                       counted(static_cast<std::size_t>(seen.frames), "frame"),
                       seen.seconds);
  } catch (const std::exception&) {
    return "";
  }
}

}  // namespace

/// Number of images that a window shows at once, and one ahead.
static constexpr std::size_t kMostImages = 4;

FetchedImage fetch_image(const FrameCache& images, int frame) {
  try {
    return {images.bgr(frame), "", false};
  } catch (const std::exception& error) {
    return {{}, message_of(error), false};
  }
}

FetchedImage ImageFetcher::get(const std::shared_ptr<const FrameCache>& images, int frame) {
  if (cv::Mat bgr = images->find(frame); !bgr.empty()) return {std::move(bgr), "", false};
  const auto lock = job_.lock();
  if (images != images_) {
    job_.cancel();
    images_ = images;
    wanted_.clear();
    answers_.clear();
    running_.reset();
  }
  const auto answer = std::ranges::find(answers_, frame, &Answer::frame);
  if (answer != answers_.end()) return answer->image;
  if (running_ != frame) {
    std::erase(wanted_, frame);
    wanted_.push_front(frame);
    if (wanted_.size() > kMostImages) wanted_.pop_back();
    job_.wake();
  }
  return {{}, "", true};
}

BackgroundJob::Job ImageFetcher::next() {
  if (wanted_.empty()) return nullptr;
  running_ = wanted_.front();
  wanted_.pop_front();
  return [this, images = images_, frame = *running_](const std::stop_token& stop) {
    FetchedImage image = fetch_image(*images, frame);
    job_.publish(stop, [&] {
      running_.reset();
      answers_.push_front({frame, std::move(image)});
      if (answers_.size() > kMostImages) answers_.pop_back();
    });
  };
}

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

BackgroundJob::Job FolderLister::next() {
  if (!std::exchange(wanted_, false)) return nullptr;
  return [this, folder = folder_](const std::stop_token& stop) {
    FolderList list = list_of(folder);
    if (job_.publish(stop, [&] { list_ = list; })) job_.notify();
    for (std::size_t i = 0; i < list.entries.size() && !stop.stop_requested(); ++i) {
      const std::string what = description_of(folder / list.entries[i].name);
      if (job_.publish(stop, [&] { list_.entries[i].what = what; })) job_.notify();
    }
    job_.publish(stop, [&] { list_.reading = false; });
  };
}

TypedPath typed_path(const std::string& text) {
  // A path typed after another one replaces it: /work//home, /work/~.
  std::string whole = text;
  if (const std::size_t at = whole.rfind("//"); at != std::string::npos) whole.erase(0, at + 1);
  if (const auto at = last_home(whole)) whole.erase(0, *at);
  if (whole == "~" || whole.starts_with("~/")) whole = home().string() + whole.substr(1);
  std::error_code none;
  if (!whole.starts_with('/')) whole = (fs::current_path(none) / whole).string();
  const std::size_t slash = whole.rfind('/');
  return {fs::path(whole.substr(0, slash + 1)).lexically_normal(), whole.substr(slash + 1)};
}

std::vector<std::string> short_names(std::span<const fs::path> paths) {
  std::vector<std::string> names;
  for (const fs::path& path : paths) {
    fs::path name = path.filename(), above = path.parent_path();
    const auto has_name = [&](const fs::path& other) {
      return other != path && other.string().ends_with("/" + name.string());
    };
    for (; above.has_filename() && std::ranges::any_of(paths, has_name);
         above = above.parent_path())
      name = above.filename() / name;
    names.push_back(name.string());
  }
  return names;
}

std::vector<FolderEntry> matching(std::span<const FolderEntry> entries, const std::string& name) {
  std::vector<FolderEntry> found;
  for (const FolderEntry& entry : entries) {
    const bool hidden = entry.name.starts_with('.') && !name.starts_with('.');
    if (!hidden && lower_case(entry.name).find(lower_case(name)) != std::string::npos)
      found.push_back(entry);
  }
  // Clang 14 cannot compile the return type of std::ranges::stable_partition.
  std::stable_partition(
      found.begin(), found.end(), [&](const auto& entry) { return begins(entry, name); });
  return found;
}

std::string completed(const std::string& text, std::span<const FolderEntry> entries) {
  const std::string name = text.substr(text.rfind('/') + 1);
  std::vector<FolderEntry> found = matching(entries, name);
  std::erase_if(found, [&](const auto& entry) { return !begins(entry, name); });
  if (found.empty()) return text;
  std::string common = found.front().name;
  for (const FolderEntry& entry : found) {
    const auto [a, b] = std::ranges::mismatch(common, entry.name);
    common.erase(a, common.end());
  }
  // Names may differ in case from the typed text.
  if (common.size() < name.size()) return text;
  const bool alone = found.size() == 1 && found.front().folder;
  return text.substr(0, text.size() - name.size()) + common + (alone ? "/" : "");
}

}  // namespace gpo
