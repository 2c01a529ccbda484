// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/frame_cache.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <stop_token>
#include <thread>

#include <opencv2/core.hpp>

namespace gpo {

/// Gray pictures for one who asks for them one after the other: the next few are decoded on a
/// thread of their own while the last one is worked on. One thread asks. Destroying it waits for no
/// more than the picture that is just being decoded.
class PicturesAhead {
 public:
  static constexpr int kAhead = 3;  ///< pictures decoded before they are asked for, at most

  /// `pictures` from `first` up to and without `end`; they are to live longer than this.
  PicturesAhead(const FrameCache& pictures, int first, int end);

  /// Picture `index`, CV_8UC1. Throws what decoding it throws. What is not the next one is decoded
  /// as if nothing were ahead.
  cv::Mat gray(int index);

 private:
  struct Entry {
    cv::Mat gray;
    std::exception_ptr error;
  };
  void decode(const std::stop_token& stop, int first, int end);

  const FrameCache& pictures_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::queue<Entry> ready_;
  int next_;              ///< of the first one that is ready or becomes it
  int end_;               ///< where decoding stops: behind the last one, or the first that failed
  std::jthread decoder_;  ///< last, so that it is joined first
};

}  // namespace gpo
