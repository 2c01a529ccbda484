// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/picture_file.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/recording/pictures/picture_bytes.h"
#include "engine/recording/pictures/picture_header.h"

#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {

namespace {

[[noreturn]] void refuse_format(const std::string& name) {
  throw InputError(name + ": found something that cannot be decoded, expected a picture");
}

/// Refuses what would not fit into memory, and formats whose decoders nobody asked for.
void check_header(const std::string& name, std::string_view bytes) {
  const auto header = read_picture_header(bytes);
  if (!header) refuse_format(name);
  check_picture_size(name, header->width, header->height);
  if (header->bits > 16) {
    throw InputError(
        fmt::format("{}: found {} bits a channel, expected 8 or 16", name, header->bits));
  }
}

}  // namespace

void check_picture_size(const std::string& name, std::int64_t width, std::int64_t height) {
  constexpr std::int64_t kMostPixels = 64'000'000;
  constexpr std::int64_t kLongestSide = 65'535;
  if (width <= kLongestSide && height <= kLongestSide && width * height <= kMostPixels) return;
  throw InputError(fmt::format("{}: found a picture of {}x{}, expected at most {} million pixels",
                               name,
                               width,
                               height,
                               kMostPixels / 1'000'000));
}

cv::Mat read_picture(const std::filesystem::path& file) {
  return decode_picture(read_file(file), file.string());
}

cv::Mat decode_picture(std::string_view bytes, const std::string& name) {
  if (!is_whole_picture(bytes)) {
    throw InputError(name + ": found a cut or broken picture, expected a whole one");
  }
  check_header(name, bytes);
  cv::Mat picture;
  try {
    std::string needed = without_remarks(bytes);
    const cv::Mat buffer(1, static_cast<int>(needed.size()), CV_8U, needed.data());
    picture = cv::imdecode(buffer, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty() || picture.depth() > CV_16U || picture.depth() == CV_8S) {
    refuse_format(name);
  }
  return picture;
}

int significant_bits(const cv::Mat& picture) {
  if (picture.depth() == CV_8U) return 8;
  double largest = 0;
  cv::minMaxLoc(picture.reshape(1), nullptr, &largest);
  for (const int bits : {10, 12, 14}) {
    if (largest < std::exp2(bits)) return bits;
  }
  return 16;
}

cv::Mat gray_if_gray(const cv::Mat& bgr) {
  cv::Mat channels[3];
  cv::split(bgr, channels);
  const bool gray = cv::norm(channels[0], channels[1], cv::NORM_INF) == 0 &&
                    cv::norm(channels[1], channels[2], cv::NORM_INF) == 0;
  return gray ? channels[0] : bgr;
}

cv::Mat to_8_bits(const cv::Mat& picture, int bits) {
  if (picture.depth() == CV_8U) return picture;
  cv::Mat reduced;
  picture.convertTo(reduced, CV_8U, 255 / (std::exp2(bits) - 1));
  return reduced;
}

}  // namespace gpo
