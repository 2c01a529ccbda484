// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/recording/frame_cache.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// Times of a video's frames, in units of `unit_s` and ascending.
struct VideoIndex {
  std::vector<std::int64_t> times;      ///< all frames, strictly ascending
  std::vector<std::int64_t> key_times;  ///< frames at which decoding can begin
  double unit_s = 0;
  cv::Size size;              ///< [px] as shown, that is after the container's rotation
  double declared_count = 0;  ///< frames according to the container; 0 if unknown
  double rate_hz = 0;         ///< average according to the container; 0 if unknown
  int quarter_turns = 0;      ///< clockwise rotation from the stored to the shown image
};

/// Decodes frames of a video file in any order, with the same result as decoding the whole file
/// from its beginning. Not thread-safe.
class VideoDecoder {
 public:
  /// Reads the whole container without decoding; if it lacks the frames' times, decodes each frame
  /// once to count them. Throws InputError.
  explicit VideoDecoder(std::filesystem::path file);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  const VideoIndex& index() const { return index_; }
  /// CV_8UC3. Throws InputError.
  cv::Mat decode(int frame);

  /// Number of frames before the requested one that are kept when stepping backward.
  static constexpr int kKept = 12;

 private:
  struct Input;
  /// Determines the next frame.
  enum class State {
    begin,    ///< the first one, after opening the file
    seeking,  ///< one near a key frame, unknown until it is decoded
    decoding  ///< the one after `last_`
  };
  /// How a frame's number is determined.
  enum class Numbering { by_time, by_count };

  int next_frame();
  int go_to(int frame);
  void restart();

  std::filesystem::path file_;
  std::unique_ptr<Input> input_;
  VideoIndex index_;
  Numbering numbering_ = Numbering::by_time;
  State state_ = State::begin;
  int last_ = 0;  ///< the frame that was decoded last
  std::map<int, cv::Mat> kept_;
};

struct VideoFile {
  std::vector<std::int64_t> timestamps_ns;  ///< all frames, strictly ascending, the first is 0
  std::shared_ptr<const FrameCache> images;
  double first_frame_s = 0;  ///< according to the container
  int quarter_turns = 0;     ///< clockwise rotation from the stored to the shown images
};

/// Opens a video without decoding it; its times are the container's. Sets the camera's size if the
/// calibration lacks it. Throws InputError if the video is unreadable, truncated, or of another
/// size than the camera.
VideoFile open_video(const std::filesystem::path& file, Camera& camera, std::size_t cache_bytes);

}  // namespace gpo
