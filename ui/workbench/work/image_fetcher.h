// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/recording/frame_cache.h"

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// An image of a recording, or the reason why it is missing.
struct FetchedImage {
  cv::Mat bgr;           ///< CV_8UC3, read-only; empty if waiting or failed
  std::string error;     ///< reason of failure, one line
  bool waiting = false;  ///< being fetched
};

/// Returns the image, decoded on the calling thread if it is not cached.
FetchedImage fetch_image(const FrameCache& images, int frame);

/// Fetches images in the background, so that drawing does not wait for a decoder. All functions may
/// be called from any thread and return at once.
class ImageFetcher {
 public:
  /// `changed` is called on the fetcher's thread when an image has arrived.
  explicit ImageFetcher(std::function<void()> changed = {});

  /// Returns the image if it is cached, else requests it. The latest request is served first and
  /// the earliest ones are discarded; another recording discards all.
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

}  // namespace gpo
