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

/// Decodes images on demand and keeps the most recently used ones within a byte limit. Thread-safe:
/// no lock is held while an image is decoded, and an image that several threads request at once is
/// decoded once.
class FrameCache {
 public:
  static constexpr std::size_t kDefaultByteLimit = std::size_t{512} << 20;
  /// Decodes image `index` to 8-bit BGR, concurrently for different indices. Throws InputError.
  using Decode = std::function<cv::Mat(int index)>;

  FrameCache(int count, Decode decode, std::size_t byte_limit = kDefaultByteLimit);

  int count() const { return count_; }
  /// Returns image `index`, CV_8UC3, shared with the cache and therefore read-only. Waits until it
  /// is decoded. Throws what the decoder throws.
  cv::Mat bgr(int index) const;
  /// The same if it is cached, otherwise empty. Never waits for a decoder.
  cv::Mat find(int index) const;
  /// Returns the image in gray, CV_8UC1; converted at every call.
  cv::Mat gray(int index) const;
  std::size_t bytes() const;
  void forget() const;

 private:
  struct Entry {
    int index;
    cv::Mat image;
  };
  // Both need the lock.
  const cv::Mat* cached(int index) const;  ///< null if not cached
  void keep(int index, const cv::Mat& image) const;

  int count_;
  Decode decode_;
  std::size_t byte_limit_;
  mutable std::mutex mutex_;
  mutable std::condition_variable decoded_;   ///< an image of `decoding_` is ready or failed
  mutable std::unordered_set<int> decoding_;  ///< each by one thread
  mutable std::size_t bytes_ = 0;
  mutable std::list<Entry> recent_;  ///< most recently used first
  mutable std::unordered_map<int, std::list<Entry>::iterator> by_index_;
};

/// Decodes gray images in sequence ahead of one thread that requests them: a background thread
/// decodes the next few while the caller works. The destructor waits for at most one image.
class ImagesAhead {
 public:
  static constexpr int kAhead = 3;  ///< largest number of images decoded in advance

  /// Decodes [first, end) of `images`, which must outlive this object.
  ImagesAhead(const FrameCache& images, int first, int end);

  /// Returns image `index`, CV_8UC1. One that is not next in the sequence is decoded directly.
  /// Throws what the decoder throws.
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
  int next_;              ///< index of the first image that is ready or in work
  int end_;               ///< decoding stops here: the end, or behind the first failure
  std::jthread decoder_;  ///< last, so that it is joined first
};

/// Calls `visit(frame, gray)` for each of the frames on all processors. Images are decoded in the
/// given order, because a video is expensive to rewind. After a stop request it returns when the
/// images in work are done. Throws what the decoder and `visit` throw.
void for_each_image(const FrameCache& images,
                    const std::vector<int>& frames,
                    const std::stop_token& stop,
                    const std::function<void(int frame, const cv::Mat& gray)>& visit);

}  // namespace gpo
