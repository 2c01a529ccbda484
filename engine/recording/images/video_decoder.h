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

/// When each frame of a video is shown, in units of `unit_s` and in the order of time.
struct VideoIndex {
  std::vector<std::int64_t> times;      ///< one a frame, strictly ascending
  std::vector<std::int64_t> key_times;  ///< of the frames from which decoding can begin
  double unit_s = 0;
  cv::Size size;              ///< [px] as shown, that is rotated as the container asks for
  double declared_count = 0;  ///< frames that the container promises; 0: it does not tell
  double rate_hz = 0;         ///< average by the container; 0: it does not tell
  int quarter_turns = 0;      ///< by which the container has the stored picture turned clockwise
};

/// Any frame of a video file, in whatever order they are asked for: each is exactly what decoding
/// the whole file from its beginning gives. One thread at a time.
class VideoDecoder {
 public:
  /// Reads the container from end to end and decodes nothing; where it does not time its frames,
  /// each is decoded once to count them. Throws InputError.
  explicit VideoDecoder(std::filesystem::path file);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  const VideoIndex& index() const { return index_; }
  /// CV_8UC3. Throws InputError.
  cv::Mat decode(int frame);

  /// On the way back so many frames before the one asked for are kept, since stepping backward will
  /// ask for them next.
  static constexpr int kKept = 12;

 private:
  struct Input;
  /// What the next frame will be.
  enum class State {
    begin,    ///< the first one; the file is opened for it
    sought,   ///< one about a key frame, which is known once it is decoded
    decoding  ///< the one after `last_`
  };
  /// By what the number of a frame is known: its time, or the frames before it.
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
  std::vector<std::int64_t> timestamps_ns;  ///< one a frame, strictly ascending, the first is 0
  std::shared_ptr<const FrameCache> images;
  double first_frame_s = 0;  ///< when the container has it
  int quarter_turns = 0;     ///< of the pictures, clockwise, from how they lie in the file
};

/// Opens a video without decoding it; times are the container's, also of a variable frame rate. The
/// camera's size is the video's where the calibration does not tell it. Throws InputError where it
/// cannot be opened, is cut, or has another size than the camera.
VideoFile open_video(const std::filesystem::path& file, Camera& camera, std::size_t cache_bytes);

}  // namespace gpo
