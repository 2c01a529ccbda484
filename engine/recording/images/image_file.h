// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// Decodes an image file: blue, green, red, 8 or 16 bits each. Throws InputError if it is missing,
/// truncated or broken; never returns a partial image.
cv::Mat read_image(const std::filesystem::path& file);
/// The same from the file's bytes; `name` replaces the file in messages.
cv::Mat decode_image(std::string_view bytes, const std::string& name);

/// Throws InputError if an image of this size would be too large for memory.
void check_image_size(const std::string& name, std::int64_t width, std::int64_t height);

/// Estimates the number of significant bits from the brightest pixel: 8, 10, 12, 14 or 16. Cameras
/// with 10 or 12 bits store 16.
int significant_bits(const cv::Mat& image);

/// Returns one channel if all three are equal, otherwise the image itself.
cv::Mat gray_if_gray(const cv::Mat& bgr);

/// Converts to CV_8UC3; values beyond `bits` become white.
cv::Mat to_8_bits(const cv::Mat& image, int bits);

/// Header of an image file, readable without allocating the image.
struct ImageHeader {
  std::int64_t width = 0;   ///< [px]
  std::int64_t height = 0;  ///< [px]
  int bits = 8;             ///< per channel; only read from TIFF, which allows more than 16
};

/// Reads the header of a PNG, JPEG, BMP, PNM, TIFF or WebP; nullopt for other formats and truncated
/// headers.
std::optional<ImageHeader> read_image_header(std::string_view bytes);

/// Throws InputError if an image has not the camera's calibrated size; a size of 0x0 is unknown.
void check_size(const std::filesystem::path& file, cv::Size size, const Camera& camera);

/// Sets at least one file as the recording's images. The first determines the number of significant
/// bits, and the camera's size if the calibration lacks it. Throws InputError.
void add_image_files(Recording& recording,
                       std::vector<std::filesystem::path> files,
                       std::size_t cache_bytes);

/// Returns the numbered images of a folder in the order of their numbers: 2.png before 10.png.
std::vector<std::filesystem::path> numbered_images(const std::filesystem::path& folder);

}  // namespace gpo
