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

/// A picture of a recording on its way to the screen.
struct FetchedImage {
  cv::Mat bgr;           ///< CV_8UC3, not to be written to; empty: see the others
  std::string error;     ///< why there is none, one line
  bool waiting = false;  ///< it is being fetched
};

/// Here and now: decodes it where it must.
FetchedImage fetch_image(const FrameCache& images, int frame);

/// Fetches pictures in the background, so that drawing waits for no decoder. All functions may be
/// called from any thread and return at once.
class ImageFetcher {
 public:
  /// `changed` is called on the fetcher's thread when a picture has come.
  explicit ImageFetcher(std::function<void()> changed = {});

  /// The picture where it is there; else it is asked for, before all that were asked for earlier,
  /// and of those the earliest are forgotten. Another recording's pictures take the place of all.
  FetchedImage get(const std::shared_ptr<const FrameCache>& images, int frame);

 private:
  struct Answer {
    int frame;
    FetchedImage image;
  };
  BackgroundJob::Job next();

  std::shared_ptr<const FrameCache> images_;  ///< to which frames count
  std::deque<int> wanted_;                      ///< the newest first
  std::optional<int> running_;
  std::deque<Answer> answers_;  ///< the newest first: the cache may have let go of them
  BackgroundJob job_;
};

}  // namespace gpo
