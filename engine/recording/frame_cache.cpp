// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/frame_cache.h"

#include "engine/base/parallel.h"
#include "engine/base/stop.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

std::size_t size_in_bytes(const cv::Mat& image) { return image.total() * image.elemSize(); }

cv::Mat gray_of(const cv::Mat& bgr) {
  cv::Mat gray;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  return gray;
}

}  // namespace

FrameCache::FrameCache(int count, Decode decode, std::size_t byte_limit)
    : count_(count), decode_(std::move(decode)), byte_limit_(byte_limit) {}

const cv::Mat* FrameCache::cached(int index) const {
  const auto found = by_index_.find(index);
  if (found == by_index_.end()) return nullptr;
  recent_.splice(recent_.begin(), recent_, found->second);
  return &recent_.front().image;
}

void FrameCache::keep(int index, const cv::Mat& image) const {
  recent_.push_front({index, image});
  by_index_[index] = recent_.begin();
  bytes_ += size_in_bytes(image);
  while (bytes_ > byte_limit_ && recent_.size() > 1) {
    bytes_ -= size_in_bytes(recent_.back().image);
    by_index_.erase(recent_.back().index);
    recent_.pop_back();
  }
}

cv::Mat FrameCache::find(int index) const {
  const std::scoped_lock lock(mutex_);
  const cv::Mat* image = cached(index);
  return image == nullptr ? cv::Mat() : *image;
}

cv::Mat FrameCache::bgr(int index) const {
  check_stop();
  std::unique_lock lock(mutex_);
  while (true) {
    if (const cv::Mat* image = cached(index)) return *image;
    // If another thread fails to decode it, this one tries again and gets the error itself.
    if (decoding_.insert(index).second) break;
    constexpr std::chrono::milliseconds kPoll{20};
    decoded_.wait_for(lock, kPoll);
    check_stop();
  }
  lock.unlock();
  cv::Mat image;
  std::exception_ptr error;
  try {
    image = decode_(index);
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  decoding_.erase(index);
  if (!error) keep(index, image);
  decoded_.notify_all();
  if (error) std::rethrow_exception(error);
  return image;
}

cv::Mat FrameCache::gray(int index) const { return gray_of(bgr(index)); }

std::size_t FrameCache::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

void FrameCache::forget() const {
  const std::scoped_lock lock(mutex_);
  by_index_.clear();
  recent_.clear();
  bytes_ = 0;
}

ImagesAhead::ImagesAhead(const FrameCache& images, int first, int end)
    : images_(images),
      next_(first),
      end_(end),
      decoder_([this, first, end, watch = current_watch()](const std::stop_token& stop) {
        const StopScope scope(watch);
        decode(stop, first, end);
      }) {}

void ImagesAhead::decode(const std::stop_token& stop, int first, int end) {
  for (int index = first; index < end; ++index) {
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return ready_.size() < kAhead; })) return;
    }
    Entry entry;
    try {
      entry.gray = images_.gray(index);
    } catch (...) {
      entry.error = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    const bool failed = entry.error != nullptr;
    ready_.push(std::move(entry));
    if (failed) end_ = index + 1;
    changed_.notify_all();
    if (failed || stop.stop_requested()) return;
  }
}

cv::Mat ImagesAhead::gray(int index) {
  std::unique_lock lock(mutex_);
  if (index != next_ || next_ >= end_) {
    lock.unlock();
    return images_.gray(index);
  }
  changed_.wait(lock, [this]() { return !ready_.empty(); });
  Entry entry = std::move(ready_.front());
  ready_.pop();
  ++next_;
  changed_.notify_all();
  if (entry.error) std::rethrow_exception(entry.error);
  return std::move(entry.gray);
}

void for_each_image(const FrameCache& images,
                    const std::vector<int>& frames,
                    const std::stop_token& stop,
                    const std::function<void(int frame, const cv::Mat& gray)>& visit) {
  std::mutex decoding;
  std::size_t next = 0;
  const auto take = [&]() -> std::optional<std::pair<int, cv::Mat>> {
    const std::scoped_lock lock(decoding);
    if (next == frames.size() || stop.stop_requested()) return std::nullopt;
    const std::size_t i = next;
    next = frames.size();  // ends the other threads if decoding throws
    std::pair image(frames[i], images.bgr(frames[i]));
    next = i + 1;
    return image;
  };
  const int count = static_cast<int>(frames.size());
  const int threads = std::min(count, static_cast<int>(std::thread::hardware_concurrency()));
  in_parallel(threads, threads, [&](int) {
    while (const auto image = take()) visit(image->first, gray_of(image->second));
  });
}

}  // namespace gpo
