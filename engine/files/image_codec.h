// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace gpo {

/// PNG and JPEG by libpng and libjpeg, with the same pixels and bytes as OpenCV's `imgcodecs`,
/// which loads more than a hundred libraries.

// The orientation of Exif metadata is not applied.

/// Decodes blue, green, red, 8 or 16 bits each. Empty if the image is broken.
cv::Mat decode_png(std::string_view bytes);
/// Decodes blue, green, red. Empty if the image is broken or has four channels.
cv::Mat decode_jpeg(std::string_view bytes);

/// `image`: 1, 3 or 4 channels of 8 or 16 bits; blue first.
std::string encode_png(const cv::Mat& image);
/// `image`: 1 or 3 channels of 8 bits; blue first. `quality`: 0 to 100.
std::string encode_jpeg(const cv::Mat& image, int quality);

}  // namespace gpo
