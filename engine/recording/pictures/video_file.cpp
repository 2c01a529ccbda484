// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/video_file.h"

#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/recording/pictures/picture_files.h"
#include "engine/recording/pictures/video_decoder.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>

namespace gpo {

namespace {

/// Whether the container promises clearly more than it holds. With a variable frame rate it may
/// declare a count made up from the duration, so the time must be short as well.
bool is_cut(const VideoIndex& index) {
  const double missing = index.declared_count - static_cast<double>(index.times.size());
  if (missing <= std::max(2.0, index.declared_count / 100)) return false;
  if (index.times.empty() || index.rate_hz <= 0) return true;
  const double duration_s =
      static_cast<double>(index.times.back() - index.times.front()) * index.unit_s;
  return index.declared_count - (duration_s * index.rate_hz + 1) > missing / 2;
}

/// From the first frame on.
std::vector<std::int64_t> timestamps_ns(const VideoIndex& index) {
  std::vector<std::int64_t> times;
  times.reserve(index.times.size());
  for (const std::int64_t time : index.times) {
    times.push_back(
        std::llround(static_cast<double>(time - index.times.front()) * index.unit_s * 1e9));
  }
  return times;
}

}  // namespace

VideoFile open_video(const std::filesystem::path& file, Camera& camera, std::size_t cache_bytes) {
  if (!is_file(file)) throw InputError(file.string() + ": no such file");
  const auto decoder = std::make_shared<VideoDecoder>(file);
  const VideoIndex& index = decoder->index();
  if (index.times.empty() || is_cut(index)) {
    throw InputError(file.string() + ": found " + std::to_string(index.times.size()) +
                     " frames that can be decoded (the file seems cut), expected " +
                     std::to_string(std::max(1L, std::lround(index.declared_count))));
  }
  check_size(file, index.size, camera);
  camera.width = index.size.width;
  camera.height = index.size.height;
  const auto one_at_a_time = std::make_shared<std::mutex>();
  const auto decode = [decoder, one_at_a_time, file, camera](int frame) {
    cv::Mat picture;
    {
      const std::scoped_lock lock(*one_at_a_time);
      picture = decoder->decode(frame);
    }
    check_size(file, picture.size(), camera);
    return picture;
  };
  // What the decoder keeps is part of the limit.
  const std::size_t kept = VideoDecoder::kKept * std::size_t{3} * index.size.area();
  const std::size_t left = cache_bytes - std::min(kept, cache_bytes / 2);
  const int count = static_cast<int>(index.times.size());
  return {timestamps_ns(index),
          std::make_shared<const FrameCache>(count, decode, left),
          static_cast<double>(index.times.front()) * index.unit_s,
          index.quarter_turns};
}

}  // namespace gpo
