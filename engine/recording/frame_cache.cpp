// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/frame_cache.h"

#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {

namespace {

std::size_t size_in_bytes(const cv::Mat& picture) { return picture.total() * picture.elemSize(); }

}  // namespace

FrameCache::FrameCache(int count, Decode decode, std::size_t byte_limit)
    : count_(count), decode_(std::move(decode)), byte_limit_(byte_limit) {}

cv::Mat FrameCache::bgr(int index) const {
  const std::scoped_lock lock(mutex_);
  if (const auto found = by_index_.find(index); found != by_index_.end()) {
    recent_.splice(recent_.begin(), recent_, found->second);
    return recent_.front().picture;
  }
  cv::Mat picture = decode_(index);
  recent_.push_front({index, picture});
  by_index_[index] = recent_.begin();
  bytes_ += size_in_bytes(picture);
  while (bytes_ > byte_limit_ && recent_.size() > 1) {
    bytes_ -= size_in_bytes(recent_.back().picture);
    by_index_.erase(recent_.back().index);
    recent_.pop_back();
  }
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
