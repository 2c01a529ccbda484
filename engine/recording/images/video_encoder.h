// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/output_file.h"

#include <filesystem>
#include <memory>

#include <opencv2/core.hpp>

namespace gpo {

/// Writes an MP4 (MPEG-4 part 2) image by image. No partial file remains on failure.
class VideoEncoder {
 public:
  /// `size` must be even. Throws InputError if the file or FFmpeg's encoder cannot be opened.
  VideoEncoder(std::filesystem::path file, double rate_hz, cv::Size size);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// Adds an image, CV_8UC3 (BGR) of the given size. Throws InputError.
  void add(const cv::Mat& image);
  /// Completes the file. Throws InputError if it cannot be written or has no image.
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

/// Rounds up to an even size, as the encoder requires.
cv::Size even_size(cv::Size size);

}  // namespace gpo
