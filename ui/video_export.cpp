// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/video_export.h"

#include "engine/error.h"
#include "engine/recording/video_decoder.h"

#include <utility>

#include <fmt/format.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

namespace gpo {
namespace {

/// The writer does not tell a full disk, but the number of frames is written last.
int frames_in(const std::filesystem::path& file) {
  try {
    return static_cast<int>(VideoDecoder(file).index().declared_count);
  } catch (const InputError&) {
    return 0;
  }
}

}  // namespace

VideoExport::VideoExport(std::filesystem::path file, double rate_hz, cv::Size size)
    : file_(std::move(file)), unfinished_(file_), size_(size) {
  const auto level = cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  writer_ = std::make_unique<cv::VideoWriter>(unfinished_.path().string(),
                                              cv::CAP_FFMPEG,
                                              cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                                              rate_hz,
                                              size_);
  cv::utils::logging::setLogLevel(level);
  if (writer_->isOpened()) return;
  throw InputError(fmt::format(
      "{}: cannot be written: OpenCV's FFmpeg has no MPEG-4 encoder for {}x{} at {:.4g} Hz",
      file_.string(),
      size_.width,
      size_.height,
      rate_hz));
}

VideoExport::~VideoExport() = default;

void VideoExport::add(const cv::Mat& picture) {
  if (picture.size() != size_) throw InputError(file_.string() + ": the picture's size changed");
  writer_->write(picture);
  ++count_;
}

void VideoExport::finish() {
  writer_->release();
  if (count_ == 0 || frames_in(unfinished_.path()) != count_) {
    throw InputError(file_.string() + ": was not written whole; is the disk full?");
  }
  unfinished_.finish();
}

cv::Size even_size(cv::Size size) {
  return {size.width + size.width % 2, size.height + size.height % 2};
}

}  // namespace gpo
