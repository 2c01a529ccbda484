// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo::test {

/// What OpenCV's writer cannot do: frames at any time, key frames far apart, frames stored in
/// another order than shown, a picture turned by the container.
struct VideoOptions {
  bool b_frames = false;        ///< MPEG-4, a key frame in 12 and two B-frames between others
  int clockwise_degrees = 0;    ///< by which a player turns the picture; MP4 and MOV only
  std::vector<int> times_ms{};  ///< one a picture; default: 25 frames a second
  std::map<std::string, std::string> metadata{};  ///< of the whole file, by its keys
};

/// Writes MJPEG (or MPEG-4 with B-frames) in the container that the file's name asks for.
void make_video(const std::filesystem::path& file,
                const std::vector<cv::Mat>& images,
                const VideoOptions& options = {});

}  // namespace gpo::test
