// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <unordered_map>
#include <unordered_set>

#include <opencv2/core.hpp>

namespace gpo {

/// Pictures decoded on demand; the most recently used ones are kept within a byte limit, never all
/// at once. Safe to share between threads (the worker and the window): no lock is held while a
/// picture is decoded, and one that several threads ask for is decoded once.
class FrameCache {
 public:
  static constexpr std::size_t kDefaultByteLimit = std::size_t{512} << 20;
  /// Decodes picture `index` (0-based): BGR, 8 bits. Throws InputError. Called by several threads
  /// at once, of different indices.
  using Decode = std::function<cv::Mat(int index)>;

  FrameCache(int count, Decode decode, std::size_t byte_limit = kDefaultByteLimit);

  int count() const { return count_; }
  /// Picture `index`, CV_8UC3; shared with the cache, not to be written to. Waits until it is
  /// decoded. Throws what decoding it throws.
  cv::Mat bgr(int index) const;
  /// The same where it is kept, else empty. Decodes nothing and waits for no decoder.
  cv::Mat find(int index) const;
  /// The same in gray, CV_8UC1; converted anew at every call.
  cv::Mat gray(int index) const;
  std::size_t bytes() const;
  /// Lets go of what it keeps; pictures that are asked for again are decoded again.
  void forget() const;

 private:
  struct Entry {
    int index;
    cv::Mat picture;
  };
  // Under the lock.
  const cv::Mat* kept(int index) const;  ///< null: it is not there
  void keep(int index, const cv::Mat& picture) const;

  int count_;
  Decode decode_;
  std::size_t byte_limit_;
  mutable std::mutex mutex_;
  mutable std::condition_variable decoded_;   ///< one of `decoding_` is there, or failed
  mutable std::unordered_set<int> decoding_;  ///< each by one thread
  mutable std::size_t bytes_ = 0;
  mutable std::list<Entry> recent_;  ///< most recently used first
  mutable std::unordered_map<int, std::list<Entry>::iterator> by_index_;
};

}  // namespace gpo
