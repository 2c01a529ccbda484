// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace gpo {

/// Decodes a picture file: blue, green, red, of 8 or 16 bits each. Throws InputError where it is
/// missing, cut or broken; a half picture is never returned.
cv::Mat read_image(const std::filesystem::path& file);
/// The same of a picture file's bytes; `name` stands for the file in messages.
cv::Mat decode_image(std::string_view bytes, const std::string& name);

/// Throws InputError where a picture of this size would not fit into memory.
void check_image_size(const std::string& name, std::int64_t width, std::int64_t height);

/// How many bits of a picture's pixels are used, judged by the brightest: 8, 10, 12, 14 or 16.
/// Cameras of 10 or 12 bits store those in pictures of 16.
int significant_bits(const cv::Mat& image);

/// One channel where all three are the same, else the picture itself.
cv::Mat gray_if_gray(const cv::Mat& bgr);

/// CV_8UC3; brighter than `bits` allow is white.
cv::Mat to_8_bits(const cv::Mat& image, int bits);

/// What the header of a picture says that it will be, before any memory is taken for it.
struct ImageHeader {
  std::int64_t width = 0;   ///< [px]
  std::int64_t height = 0;  ///< [px]
  int bits = 8;             ///< a channel, where the format is TIFF, which knows more than 16
};

/// Reads the header of a PNG, JPEG, BMP, PNM, TIFF or WebP; nothing for other bytes and headers
/// that are cut.
std::optional<ImageHeader> read_image_header(std::string_view bytes);

}  // namespace gpo
