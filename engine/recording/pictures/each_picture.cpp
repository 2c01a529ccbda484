// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/each_picture.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <thread>

#include <opencv2/imgproc.hpp>

namespace gpo {

namespace {

struct Picture {
  int frame;
  cv::Mat bgr;
};

}  // namespace

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
