// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/output_file.h"

#include <filesystem>
#include <memory>

#include <opencv2/core.hpp>

namespace gpo {

/// An MP4 (MPEG-4 part 2) that is written picture by picture: the whole file or none of it.
class VideoEncoder {
 public:
  /// Width and height of the pictures are even. Throws InputError where the file cannot be written
  /// or FFmpeg has no encoder.
  VideoEncoder(std::filesystem::path file, double rate_hz, cv::Size size);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// CV_8UC3, BGR, as large as said before. Throws InputError.
  void add(const cv::Mat& image);
  /// Gives the file its name. Throws InputError where nothing whole was written.
  void finish();

  const std::filesystem::path& file() const { return file_; }

 private:
  struct Output;
  void check(int result) const;
  void drain();

  std::filesystem::path file_;
  AtomicFile unfinished_;
  cv::Size size_;
  int count_ = 0;
  std::unique_ptr<Output> output_;
};

/// The next even size: what the encoder can write.
cv::Size even_size(cv::Size size);

}  // namespace gpo
