// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/image_fetcher.h"

#include "engine/base/error.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace gpo {

/// Number of images that a window shows at once, and one ahead.
static constexpr std::size_t kMostImages = 4;

FetchedImage fetch_image(const FrameCache& images, int frame) {
  try {
    return {images.bgr(frame), "", false};
  } catch (const std::exception& error) {
    return {{}, message_of(error), false};
  }
}

ImageFetcher::ImageFetcher(std::function<void()> changed)
    : job_([this] { return next(); }, std::move(changed)) {}

FetchedImage ImageFetcher::get(const std::shared_ptr<const FrameCache>& images, int frame) {
  if (cv::Mat bgr = images->find(frame); !bgr.empty()) return {std::move(bgr), "", false};
  const auto lock = job_.lock();
  if (images != images_) {
    job_.cancel();
    images_ = images;
    wanted_.clear();
    answers_.clear();
    running_.reset();
  }
  const auto answer = std::ranges::find(answers_, frame, &Answer::frame);
  if (answer != answers_.end()) return answer->image;
  if (running_ != frame) {
    std::erase(wanted_, frame);
    wanted_.push_front(frame);
    if (wanted_.size() > kMostImages) wanted_.pop_back();
    job_.wake();
  }
  return {{}, "", true};
}

BackgroundJob::Job ImageFetcher::next() {
  if (wanted_.empty()) return nullptr;
  running_ = wanted_.front();
  wanted_.pop_front();
  return [this, images = images_, frame = *running_](const std::stop_token& stop) {
    FetchedImage image = fetch_image(*images, frame);
    job_.publish(stop, [&] {
      running_.reset();
      answers_.push_front({frame, std::move(image)});
      if (answers_.size() > kMostImages) answers_.pop_back();
    });
  };
}

}  // namespace gpo
