// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/frame_cache.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

std::size_t size_in_bytes(const cv::Mat& picture) { return picture.total() * picture.elemSize(); }

struct Picture {
  int frame;
  cv::Mat bgr;
};

}  // namespace

FrameCache::FrameCache(int count, Decode decode, std::size_t byte_limit)
    : count_(count), decode_(std::move(decode)), byte_limit_(byte_limit) {}

const cv::Mat* FrameCache::kept(int index) const {
  const auto found = by_index_.find(index);
  if (found == by_index_.end()) return nullptr;
  recent_.splice(recent_.begin(), recent_, found->second);
  return &recent_.front().picture;
}

void FrameCache::keep(int index, const cv::Mat& picture) const {
  recent_.push_front({index, picture});
  by_index_[index] = recent_.begin();
  bytes_ += size_in_bytes(picture);
  while (bytes_ > byte_limit_ && recent_.size() > 1) {
    bytes_ -= size_in_bytes(recent_.back().picture);
    by_index_.erase(recent_.back().index);
    recent_.pop_back();
  }
}

cv::Mat FrameCache::find(int index) const {
  const std::scoped_lock lock(mutex_);
  const cv::Mat* picture = kept(index);
  return picture == nullptr ? cv::Mat() : *picture;
}

cv::Mat FrameCache::bgr(int index) const {
  std::unique_lock lock(mutex_);
  while (true) {
    if (const cv::Mat* picture = kept(index)) return *picture;
    // Where another thread fails to decode it this one tries, too, and so has the error itself.
    if (decoding_.insert(index).second) break;
    decoded_.wait(lock);
  }
  lock.unlock();
  cv::Mat picture;
  std::exception_ptr error;
  try {
    picture = decode_(index);
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  decoding_.erase(index);
  if (!error) keep(index, picture);
  decoded_.notify_all();
  if (error) std::rethrow_exception(error);
  return picture;
}

cv::Mat FrameCache::gray(int index) const {
  cv::Mat gray;
  cv::cvtColor(bgr(index), gray, cv::COLOR_BGR2GRAY);
  return gray;
}

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

PicturesAhead::PicturesAhead(const FrameCache& pictures, int first, int end)
    : pictures_(pictures),
      next_(first),
      end_(end),
      decoder_([this, first, end](const std::stop_token& stop) { decode(stop, first, end); }) {}

void PicturesAhead::decode(const std::stop_token& stop, int first, int end) {
  for (int index = first; index < end; ++index) {
    {
      std::unique_lock lock(mutex_);
      const auto is_room = [this]() { return ready_.size() < kAhead; };
      if (!changed_.wait(lock, stop, is_room)) return;
    }
    Entry entry;
    try {
      entry.gray = pictures_.gray(index);
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

cv::Mat PicturesAhead::gray(int index) {
  std::unique_lock lock(mutex_);
  if (index != next_ || next_ >= end_) {
    lock.unlock();
    return pictures_.gray(index);
  }
  changed_.wait(lock, [this]() { return !ready_.empty(); });
  Entry entry = std::move(ready_.front());
  ready_.pop();
  ++next_;
  changed_.notify_all();
  if (entry.error) std::rethrow_exception(entry.error);
  return std::move(entry.gray);
}

void for_each_picture(const FrameCache& pictures,
                      const std::vector<int>& frames,
                      const std::stop_token& stop,
                      const std::function<void(int frame, const cv::Mat& gray)>& look) {
  std::mutex decoding;
  std::size_t next = 0;
  const auto take = [&]() -> std::optional<Picture> {
    const std::scoped_lock lock(decoding);
    if (next == frames.size() || stop.stop_requested()) return std::nullopt;
    const std::size_t i = next;
    next = frames.size();  // where decoding throws the others have nothing left to do
    Picture picture{frames[i], pictures.bgr(frames[i])};
    next = i + 1;
    return picture;
  };
  const int count = static_cast<int>(frames.size());
  const int threads = std::min(count, static_cast<int>(std::thread::hardware_concurrency()));
  in_parallel(threads, threads, [&](int) {
    while (const auto picture = take()) {
      cv::Mat gray;
      cv::cvtColor(picture->bgr, gray, cv::COLOR_BGR2GRAY);
      look(picture->frame, gray);
    }
  });
}

}  // namespace gpo
