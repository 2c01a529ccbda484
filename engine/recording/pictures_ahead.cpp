// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures_ahead.h"

#include <utility>

namespace gpo {

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

}  // namespace gpo
