// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/messages.h"
#include "engine/recording/images/decoders.h"
#include "engine/recording/refuse.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kNoConversion = -1;

struct PixelFormat {
  const char* name;
  int type;        ///< OpenCV's type of the stored pixels
  int conversion;  ///< OpenCV's conversion to blue, green, red
};

// ROS names a Bayer pattern by the first two pixels of its first two rows, OpenCV by the second and
// third of its second row: rggb is its BG.
constexpr std::array<PixelFormat, 24> kPixelFormats = {
    {{"mono8", CV_8UC1, cv::COLOR_GRAY2BGR},
     {"8UC1", CV_8UC1, cv::COLOR_GRAY2BGR},
     {"mono16", CV_16UC1, cv::COLOR_GRAY2BGR},
     {"16UC1", CV_16UC1, cv::COLOR_GRAY2BGR},
     {"bgr8", CV_8UC3, kNoConversion},
     {"8UC3", CV_8UC3, kNoConversion},
     {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
     {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
     {"8UC4", CV_8UC4, cv::COLOR_BGRA2BGR},
     {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
     {"bgr16", CV_16UC3, kNoConversion},
     {"rgb16", CV_16UC3, cv::COLOR_RGB2BGR},
     {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
     {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
     {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
     {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
     {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2BGR},
     {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2BGR},
     {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2BGR},
     {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2BGR},
     {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
     {"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
     {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
     {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2}}};

const PixelFormat& format_of(const ImageMessage& image, const std::string& name) {
  const auto found = std::ranges::find_if(
      kPixelFormats, [&](const PixelFormat& one) { return image.encoding == one.name; });
  if (found != kPixelFormats.end()) return *found;
  refuse(name,
         "found pixel encoding \"{}\", expected one of ROS' gray and color encodings with 8 or 16 "
         "bits such as mono8, bgr8, rgb8, bayer_rggb8 or mono16",
         image.encoding);
}

/// Returns the pixels without padding, in the machine's byte order.
cv::Mat stored_pixels(const ImageMessage& image, const PixelFormat& format) {
  cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), format.type);
  const std::size_t row = pixels.cols * pixels.elemSize();
  for (int y = 0; y < pixels.rows; ++y)
    std::memcpy(pixels.ptr(y), image.data.data() + std::size_t{image.step} * y, row);
  if (image.big_endian && pixels.depth() == CV_16U)
    for (int y = 0; y < pixels.rows; ++y)
      for (std::size_t i = 0; i + 1 < row; i += 2)
        std::swap(pixels.ptr(y)[i], pixels.ptr(y)[i + 1]);
  return pixels;
}

void check_data_size(const ImageMessage& image,
                     const PixelFormat& format,
                     const std::string& name) {
  check_image_size(name, image.width, image.height);
  const std::uint64_t row = std::uint64_t{image.width} * CV_ELEM_SIZE(format.type);
  const std::uint64_t rows = image.height;
  if (rows > 0 && row > 0 && image.step >= row &&
      image.data.size() >= std::uint64_t{image.step} * (rows - 1) + row)
    return;
  refuse(name,
         "found {} bytes in rows of {}, expected an image of {}x{} {}",
         image.data.size(),
         image.step,
         image.width,
         image.height,
         image.encoding);
}

cv::Mat decode_raw(const ImageMessage& image, const std::string& name) {
  const PixelFormat& format = format_of(image, name);
  check_data_size(image, format, name);
  cv::Mat pixels = stored_pixels(image, format);
  if (format.conversion == kNoConversion) return pixels;
  cv::Mat bgr;
  try {
    cv::cvtColor(pixels, bgr, format.conversion);
  } catch (const cv::Exception&) {
    refuse(name,
           "an image of {}x{} cannot have the encoding {}",
           image.width,
           image.height,
           image.encoding);
  }
  return bgr;
}

}  // namespace

cv::Mat bag_image(std::string_view bytes, const BagTopic& topic, const std::string& name) {
  if (topic.type == "sensor_msgs/CompressedImage") {
    const auto message = read_compressed_image(bytes, topic.encoding);
    if (message) return decode_image(message->data, name);
  } else if (const auto message = read_image(bytes, topic.encoding)) {
    return decode_raw(*message, name);
  }
  refuse(name, "truncated or broken message, expected {}", topic.type);
}

}  // namespace gpo
