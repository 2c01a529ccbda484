// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/recording/frame_cache.h"

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

struct FetchedImage {
  cv::Mat bgr;           ///< CV_8UC3, read-only; empty if waiting or failed
  std::string error;     ///< reason of failure, one line
  bool waiting = false;  ///< being fetched
};

/// Returns the image, decoded on the calling thread if it is not cached.
FetchedImage fetch_image(const FrameCache& images, int frame);

/// Fetches images in the background: drawing does not wait for a decoder. Thread-safe.
class ImageFetcher {
 public:
  /// `changed` is called on the fetcher's thread when an image has arrived.
  explicit ImageFetcher(std::function<void()> changed = {})
      : job_([this] { return next(); }, std::move(changed)) {}

  /// Returns the image if cached, else requests it: the latest first, the earliest are dropped.
  FetchedImage get(const std::shared_ptr<const FrameCache>& images, int frame);

 private:
  struct Answer {
    int frame;
    FetchedImage image;
  };
  BackgroundJob::Job next();

  std::shared_ptr<const FrameCache> images_;  ///< source of the requested images
  std::deque<int> wanted_;                    ///< the latest first
  std::optional<int> running_;
  std::deque<Answer> answers_;  ///< the latest first; the cache may have dropped them
  BackgroundJob job_;
};

struct FolderEntry {
  std::string name;
  bool folder = false;
  std::string what = {};  ///< "EuRoC · 60 frames · 2.0 s", "session"; empty: cannot be opened
};

struct FolderList {
  std::vector<FolderEntry> entries;  ///< folders first, each by name
  std::string error;                 ///< reason of failure, one line
  bool reading = false;              ///< entries or their descriptions are incomplete
};

/// Lists folders in the background: a slow disk does not block the window. Thread-safe.
class FolderLister {
 public:
  /// `changed` is called on the lister's thread when the list has grown.
  explicit FolderLister(std::function<void()> changed = {})
      : job_([this] { return next(); }, std::move(changed)) {}

  /// Returns the current list of the folder and discards that of the previous one.
  FolderList list(const std::filesystem::path& folder);

 private:
  BackgroundJob::Job next();

  std::filesystem::path folder_;
  bool wanted_ = false;  ///< requested, but not begun
  FolderList list_;
  BackgroundJob job_;
};

/// The text typed into the field: a folder and a part of a name in it. "~" is the home folder,
/// relative paths begin in the working folder, "//" begins a new absolute path.
struct TypedPath {
  std::filesystem::path folder;
  std::string name;

  std::filesystem::path whole() const { return folder / name; }
};
TypedPath typed_path(const std::string& text);

/// Returns the last parts of each path, as many as distinguish it from the others.
std::vector<std::string> short_names(std::span<const std::filesystem::path> paths);

/// The entries that contain the typed name, in any case, those that begin with it first.
std::vector<FolderEntry> matching(std::span<const FolderEntry> entries, const std::string& name);

/// Completes the name in the text as far as all matching entries agree; enters a single folder.
std::string completed(const std::string& text, std::span<const FolderEntry> entries);

}  // namespace gpo
