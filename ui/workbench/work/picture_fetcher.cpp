// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/picture_fetcher.h"

#include "engine/base/error.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace gpo {
namespace {

/// Pictures that a window shows at once, and one to come.
constexpr std::size_t kMost = 4;

}  // namespace

FetchedPicture fetch_picture(const FrameCache& pictures, int frame) {
  try {
    return {pictures.bgr(frame), "", false};
  } catch (const std::exception& error) {
    return {{}, message_of(error), false};
  }
}

PictureFetcher::PictureFetcher(std::function<void()> changed)
    : changed_(std::move(changed)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

FetchedPicture PictureFetcher::get(const std::shared_ptr<const FrameCache>& pictures, int frame) {
  if (cv::Mat bgr = pictures->find(frame); !bgr.empty()) return {std::move(bgr), "", false};
  const std::scoped_lock lock(mutex_);
  if (pictures != pictures_) {
    pictures_ = pictures;
    wanted_.clear();
    answers_.clear();
    running_.reset();
  }
  const auto answer = std::ranges::find(answers_, frame, &Answer::frame);
  if (answer != answers_.end()) return answer->picture;
  if (running_ != frame) {
    std::erase(wanted_, frame);
    wanted_.push_front(frame);
    if (wanted_.size() > kMost) wanted_.pop_back();
    wake_.notify_one();
  }
  return {{}, "", true};
}

void PictureFetcher::run(const std::stop_token& stop) {
  while (true) {
    std::shared_ptr<const FrameCache> pictures;
    int frame = 0;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [this] { return !wanted_.empty(); });
      if (stop.stop_requested()) return;  // whatever was still asked for
      pictures = pictures_;
      frame = wanted_.front();
      wanted_.pop_front();
      running_ = frame;
    }
    FetchedPicture picture = fetch_picture(*pictures, frame);
    {
      const std::scoped_lock lock(mutex_);
      if (pictures != pictures_) continue;
      running_.reset();
      answers_.push_front({frame, std::move(picture)});
      if (answers_.size() > kMost) answers_.pop_back();
    }
    if (changed_) changed_();
  }
}

}  // namespace gpo
