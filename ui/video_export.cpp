// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/video_export.h"

#include "engine/error.h"
#include "engine/output_file.h"

#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

namespace gpo {

VideoExport::VideoExport(std::filesystem::path file, double rate_hz, cv::Size size)
    : file_(std::move(file)), size_(size) {
  check_writable(file_);
  partial_ = file_.parent_path() / (file_.stem().string() + ".partial.mp4");
  const auto level = cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  writer_ = std::make_unique<cv::VideoWriter>(partial_.string(),
                                              cv::CAP_FFMPEG,
                                              cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                                              rate_hz,
                                              size_);
  cv::utils::logging::setLogLevel(level);
  if (writer_->isOpened()) return;
  std::error_code none;
  std::filesystem::remove(partial_, none);
  throw InputError(fmt::format(
      "{}: cannot be written: OpenCV's FFmpeg has no MPEG-4 encoder for {}x{} at {:.4g} Hz",
      file_.string(),
      size_.width,
      size_.height,
      rate_hz));
}

VideoExport::~VideoExport() {
  writer_.reset();
  std::error_code none;
  std::filesystem::remove(partial_, none);
}

void VideoExport::add(const cv::Mat& picture) {
  if (picture.size() != size_) throw InputError(file_.string() + ": the picture's size changed");
  writer_->write(picture);
  ++count_;
}

void VideoExport::finish() {
  writer_->release();
  std::error_code failed;
  if (count_ == 0 || std::filesystem::file_size(partial_, failed) == 0 || failed)
    throw InputError(file_.string() + ": nothing was written, expected a movie; is the disk full?");
  std::filesystem::rename(partial_, file_, failed);
  if (failed) throw InputError(fmt::format("{}: {}", file_.string(), failed.message()));
}

cv::Size even_size(cv::Size size) {
  return {size.width + size.width % 2, size.height + size.height % 2};
}

}  // namespace gpo
