// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/smoothed_image.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace gpo {

// In 16 bits throughout so that the compiler vectorizes it, eight pixels at a time.
cv::Mat smooth_image(const cv::Mat& gray) {
  cv::Mat image(gray.size(), CV_16UC1);
  std::vector<std::uint16_t> column_sums(gray.cols + 2);
  std::uint16_t* sums = column_sums.data() + 1;
  for (int v = 0; v < gray.rows; ++v) {
    const auto* above = gray.ptr<std::uint8_t>(std::max(v - 1, 0));
    const auto* row = gray.ptr<std::uint8_t>(v);
    const auto* below = gray.ptr<std::uint8_t>(std::min(v + 1, gray.rows - 1));
    for (int u = 0; u < gray.cols; ++u)
      sums[u] = static_cast<std::uint16_t>(above[u] + 6 * row[u] + below[u]);
    sums[-1] = sums[0];
    sums[gray.cols] = sums[gray.cols - 1];
    auto* out = image.ptr<std::uint16_t>(v);
    for (int u = 0; u < gray.cols; ++u)
      out[u] = static_cast<std::uint16_t>(sums[u - 1] + 6 * sums[u] + sums[u + 1]);
  }
  return image;
}

cv::Mat halved(const cv::Mat& image) {
  cv::Mat half(image.rows / 2, image.cols / 2, CV_16UC1);
  for (int v = 0; v < half.rows; ++v) {
    const auto* upper = image.ptr<std::uint16_t>(2 * v);
    const auto* lower = image.ptr<std::uint16_t>(2 * v + 1);
    auto* out = half.ptr<std::uint16_t>(v);
    for (int u = 0; u < half.cols; ++u) {
      const int k = 2 * u;
      // Four times 255 * 64 are below 2^16.
      out[u] = static_cast<std::uint16_t>((upper[k] + upper[k + 1] + lower[k] + lower[k + 1]) / 4);
    }
  }
  return half;
}

}  // namespace gpo
