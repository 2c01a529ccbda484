// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/live/live_recording.h"

#include "engine/files/refuse.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

namespace gpo {
namespace {

std::size_t bytes_of(const cv::Mat& image) { return image.total() * image.elemSize(); }

fs::path spool_file(const fs::path& output) {
  const fs::path file = fs::absolute(output).lexically_normal();
  const fs::path whole = file.has_filename() ? file : file.parent_path();
  make_folder(folder_of(whole));
  return folder_of(whole) / (whole.filename().string() + ".frames");
}

}  // namespace

Recording live_recording(const LiveOrigin& origin, const LiveImages& live) {
  Recording recording;
  recording.path = origin.address;
  recording.name = origin.device.empty() ? origin.address : origin.device;
  recording.layout = kLiveLayout;
  recording.timestamps_ns = live.timestamps_ns;
  recording.images = live.images;
  const cv::Size size = live.images->bgr(0).size();
  recording.camera.width = size.width;
  recording.camera.height = size.height;
  const auto& known = origin.camera;
  if (known && known->camera.width == size.width && known->camera.height == size.height)
    set_camera(recording, known->camera, known->source, known->detail);
  else
    guess_camera(recording);
  recording.notes.emplace_back("no gyroscope: rotations from the images alone");
  recording.notes.emplace_back("no ground truth: no metrics");
  return recording;
}

std::shared_ptr<const FrameCache> images_in_memory(std::vector<cv::Mat> images) {
  const int count = static_cast<int>(images.size());
  const auto shared = std::make_shared<const std::vector<cv::Mat>>(std::move(images));
  return std::make_shared<const FrameCache>(count, [shared](int index) {
    const cv::Mat& image = (*shared)[index];
    if (image.channels() == 3) return image;
    cv::Mat bgr;
    cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
    return bgr;
  });
}

void LiveBuffer::add(const LiveImage& image) {
  if (!images_.empty() && images_.back().segment != image.segment) {
    images_.clear();
    bytes_ = 0;
  }
  images_.push_back({gray_if_gray(image.bgr), image.timestamp_ns, image.segment});
  bytes_ += bytes_of(images_.back().bgr);
  const auto oldest_ns = image.timestamp_ns - static_cast<std::int64_t>(seconds_ * 1e9);
  while (images_.size() > 1 && (bytes_ > most_bytes_ || images_.front().timestamp_ns < oldest_ns)) {
    bytes_ -= bytes_of(images_.front().bgr);
    images_.pop_front();
  }
}

LiveImages LiveBuffer::images(std::span<const LiveImage> earlier) const {
  LiveImages live;
  std::vector<cv::Mat> images;
  const auto add = [&](const LiveImage& one) {
    live.timestamps_ns.push_back(one.timestamp_ns);
    images.push_back(one.bgr);
  };
  for (const LiveImage& one : earlier)
    if (images_.empty() || one.timestamp_ns < images_.front().timestamp_ns) add(one);
  for (const LiveImage& one : images_) add(one);
  live.images = images_in_memory(std::move(images));
  return live;
}

struct FrameSpool::File {
  int number;
  explicit File(const fs::path& path)
      : number(::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)) {
    if (number < 0) refuse(path, "cannot be written: {}", std::strerror(errno));
  }
  ~File() { ::close(number); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
};

FrameSpool::FrameSpool(const fs::path& output)
    : output_(output),
      unfinished_(spool_file(output)),
      file_(std::make_shared<File>(unfinished_.path())) {}

void FrameSpool::add(const LiveImage& image) {
  if (timestamps_ns_.empty()) size_ = image.bgr.size();
  const cv::Mat pixels = image.bgr.isContinuous() ? image.bgr : image.bgr.clone();
  const std::size_t bytes = bytes_of(pixels);
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t written = ::write(file_->number, pixels.data + done, bytes - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      refuse(output_, "cannot be written: {}", written < 0 ? std::strerror(errno) : "no space");
    done += static_cast<std::size_t>(written);
  }
  timestamps_ns_.push_back(image.timestamp_ns);
}

LiveImages FrameSpool::images() const {
  const auto read = [file = file_, size = size_, output = output_](int index) {
    cv::Mat bgr(size, CV_8UC3);
    const std::size_t bytes = bytes_of(bgr);
    const auto begin = static_cast<off_t>(bytes) * index;
    for (std::size_t done = 0; done < bytes;) {
      const ssize_t got =
          ::pread(file->number, bgr.data + done, bytes - done, begin + static_cast<off_t>(done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) refuse(output, "frame {} cannot be read back from the disk", index);
      done += static_cast<std::size_t>(got);
    }
    return bgr;
  };
  constexpr std::size_t kCacheBytes = std::size_t{64} << 20;
  return {timestamps_ns_, std::make_shared<const FrameCache>(count(), read, kCacheBytes)};
}

}  // namespace gpo
