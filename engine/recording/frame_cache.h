// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <queue>
#include <stop_token>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <vector>

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
    cv::Mat image;
  };
  // Under the lock.
  const cv::Mat* kept(int index) const;  ///< null: it is not there
  void keep(int index, const cv::Mat& image) const;

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

/// Gray pictures for one who asks for them one after the other: the next few are decoded on a
/// thread of their own while the last one is worked on. One thread asks. Destroying it waits for no
/// more than the picture that is just being decoded.
class ImagesAhead {
 public:
  static constexpr int kAhead = 3;  ///< pictures decoded before they are asked for, at most

  /// `images` from `first` up to and without `end`; they are to live longer than this.
  ImagesAhead(const FrameCache& images, int first, int end);

  /// Picture `index`, CV_8UC1. Throws what decoding it throws. What is not the next one is decoded
  /// as if nothing were ahead.
  cv::Mat gray(int index);

 private:
  struct Entry {
    cv::Mat gray;
    std::exception_ptr error;
  };
  void decode(const std::stop_token& stop, int first, int end);

  const FrameCache& images_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::queue<Entry> ready_;
  int next_;              ///< of the first one that is ready or becomes it
  int end_;               ///< where decoding stops: behind the last one, or the first that failed
  std::jthread decoder_;  ///< last, so that it is joined first
};

/// Calls `look(frame, gray)` for each of the frames, on all processors at once. They are decoded in
/// the order given, because a video goes backward only from its beginning again. Once stopped it
/// returns when the pictures at work are done. Throws what decoding and `look` throw.
void for_each_image(const FrameCache& images,
                      const std::vector<int>& frames,
                      const std::stop_token& stop,
                      const std::function<void(int frame, const cv::Mat& gray)>& look);

}  // namespace gpo
