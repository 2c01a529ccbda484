// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/frame_cache.h"

#include <exception>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {

namespace {

std::size_t size_in_bytes(const cv::Mat& picture) { return picture.total() * picture.elemSize(); }

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

}  // namespace gpo
