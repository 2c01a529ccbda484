// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/live/sources.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace gpo {
namespace {

constexpr int kMostCameras = 64;

class CameraFile {
 public:
  explicit CameraFile(int number)
      : file_(
            ::open(fmt::format("/dev/video{}", number).c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {}
  ~CameraFile() {
    if (file_ >= 0) ::close(file_);
  }
  CameraFile(const CameraFile&) = delete;
  CameraFile& operator=(const CameraFile&) = delete;

  bool is_open() const { return file_ >= 0; }
  bool ask(unsigned long request, void* answer) const {
    return ::ioctl(file_, request, answer) == 0;
  }

 private:
  int file_;
};

double highest_rate_hz(const CameraFile& camera, std::uint32_t format, cv::Size size) {
  double highest = 0;
  v4l2_frmivalenum interval{};
  interval.pixel_format = format;
  interval.width = static_cast<std::uint32_t>(size.width);
  interval.height = static_cast<std::uint32_t>(size.height);
  for (; camera.ask(VIDIOC_ENUM_FRAMEINTERVALS, &interval); ++interval.index) {
    const bool discrete = interval.type == V4L2_FRMIVAL_TYPE_DISCRETE;
    const v4l2_fract& shortest = discrete ? interval.discrete : interval.stepwise.min;
    if (shortest.numerator > 0)
      highest = std::max(highest, static_cast<double>(shortest.denominator) / shortest.numerator);
    if (!discrete) break;
  }
  return highest;
}

std::vector<CameraMode> modes_of(const CameraFile& camera) {
  std::map<std::pair<int, int>, double> rates;  // by height and width
  v4l2_fmtdesc format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  for (; camera.ask(VIDIOC_ENUM_FMT, &format); ++format.index) {
    v4l2_frmsizeenum size{};
    size.pixel_format = format.pixelformat;
    for (; camera.ask(VIDIOC_ENUM_FRAMESIZES, &size); ++size.index) {
      const bool discrete = size.type == V4L2_FRMSIZE_TYPE_DISCRETE;
      const cv::Size pixels(
          static_cast<int>(discrete ? size.discrete.width : size.stepwise.max_width),
          static_cast<int>(discrete ? size.discrete.height : size.stepwise.max_height));
      double& rate_hz = rates[{pixels.height, pixels.width}];
      rate_hz = std::max(rate_hz, highest_rate_hz(camera, format.pixelformat, pixels));
      if (!discrete) break;
    }
  }
  std::vector<CameraMode> modes;
  for (const auto& [size, rate_hz] : rates) modes.push_back({{size.second, size.first}, rate_hz});
  std::ranges::reverse(modes);
  return modes;
}

}  // namespace

std::vector<CameraDevice> list_cameras() {
  std::vector<CameraDevice> cameras;
  for (int number = 0; number < kMostCameras; ++number) {
    const CameraFile camera(number);
    v4l2_capability found{};
    if (!camera.is_open() || !camera.ask(VIDIOC_QUERYCAP, &found)) continue;
    const std::uint32_t can =
        (found.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? found.device_caps : found.capabilities;
    if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) continue;
    const char* name = reinterpret_cast<const char*>(found.card);
    cameras.push_back(
        {number, std::string(name, strnlen(name, sizeof found.card)), modes_of(camera)});
  }
  return cameras;
}

std::string camera_error(const std::string& address, int error) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV: {
      std::string found;
      for (const CameraDevice& one : list_cameras())
        found += fmt::format("{}camera:{} ({})", found.empty() ? "" : ", ", one.number, one.name);
      return fmt::format("{}: no such camera; found {}", address, found.empty() ? "none" : found);
    }
    case EACCES:
    case EPERM:
      return address + ": no permission; add your user to the group video";
    case EBUSY:
      return address + ": another program uses it; close that one";
    case ENOTTY:
    case EINVAL:
      return address + ": is no camera that V4L2 can read";
    default:
      return fmt::format("{}: cannot be opened: {}", address, std::strerror(error));
  }
}

}  // namespace gpo
