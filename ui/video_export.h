// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/output_file.h"

#include <filesystem>
#include <memory>

#include <opencv2/core.hpp>

namespace cv {
class VideoWriter;
}

namespace gpo {

/// An MP4 (MPEG-4 part 2) that is written picture by picture: the whole file or none of it.
class VideoExport {
 public:
  /// Width and height of the pictures are even. Throws InputError where the file cannot be written
  /// or OpenCV has no encoder.
  VideoExport(std::filesystem::path file, double rate_hz, cv::Size size);
  ~VideoExport();
  VideoExport(const VideoExport&) = delete;
  VideoExport& operator=(const VideoExport&) = delete;

  /// CV_8UC3, BGR, as large as said before.
  void add(const cv::Mat& picture);
  /// Gives the file its name. Throws InputError where nothing whole was written.
  void finish();

  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  UnfinishedFile unfinished_;
  cv::Size size_;
  int count_ = 0;
  std::unique_ptr<cv::VideoWriter> writer_;
};

/// The next even size: what the encoder can write.
cv::Size even_size(cv::Size size);

}  // namespace gpo
