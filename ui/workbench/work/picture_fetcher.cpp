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
    : job_([this] { return next(); }, std::move(changed)) {}

FetchedPicture PictureFetcher::get(const std::shared_ptr<const FrameCache>& pictures, int frame) {
  if (cv::Mat bgr = pictures->find(frame); !bgr.empty()) return {std::move(bgr), "", false};
  const auto lock = job_.lock();
  if (pictures != pictures_) {
    job_.cancel();
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
    job_.wake();
  }
  return {{}, "", true};
}

BackgroundJob::Job PictureFetcher::next() {
  if (wanted_.empty()) return nullptr;
  running_ = wanted_.front();
  wanted_.pop_front();
  return [this, pictures = pictures_, frame = *running_](const std::stop_token& stop) {
    FetchedPicture picture = fetch_picture(*pictures, frame);
    job_.publish(stop, [&] {
      running_.reset();
      answers_.push_front({frame, std::move(picture)});
      if (answers_.size() > kMost) answers_.pop_back();
    });
  };
}

}  // namespace gpo
