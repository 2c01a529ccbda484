// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/processor.h"
#include "engine/tracking/patch.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace gpo {
namespace {

// Sixteen pixels: one register of AVX2, two of the baseline. All sums fit into 16 bits.
using GrayPixels = std::uint8_t __attribute__((vector_size(16)));
using SmoothedPixels = std::uint16_t __attribute__((vector_size(32)));
using TwoRowSums = std::uint32_t __attribute__((vector_size(32)));  // sums two neighbors each
using EightMeans = std::uint16_t __attribute__((vector_size(16)));
constexpr int kPixels = 16;

// The calling convention of functions that return vectors depends on the instruction set.
[[gnu::always_inline]] inline void load(const std::uint8_t* pixels, SmoothedPixels& values) {
  GrayPixels gray;
  std::memcpy(&gray, pixels, sizeof(gray));
  values = __builtin_convertvector(gray, SmoothedPixels);
}

[[gnu::always_inline]] inline void load(const std::uint16_t* pixels, SmoothedPixels& values) {
  std::memcpy(&values, pixels, sizeof(values));
}

/// Weights three neighbors by (1 6 1), sixteen times.
template <class Pixel>
[[gnu::always_inline]] inline void smooth(const Pixel* first,
                                          const Pixel* middle,
                                          const Pixel* last,
                                          std::uint16_t* out) {
  SmoothedPixels a, b, c;
  load(first, a);
  load(middle, b);
  load(last, c);
  a += 6 * b + c;
  std::memcpy(out, &a, sizeof(a));
}

[[gnu::always_inline]] inline void smooth_rows(const cv::Mat& gray, cv::Mat& image) {
  std::vector<std::uint16_t> column_sums(gray.cols + 2);
  std::uint16_t* sums = column_sums.data() + 1;
  for (int v = 0; v < gray.rows; ++v) {
    const auto* above = gray.ptr<std::uint8_t>(std::max(v - 1, 0));
    const auto* row = gray.ptr<std::uint8_t>(v);
    const auto* below = gray.ptr<std::uint8_t>(std::min(v + 1, gray.rows - 1));
    int u = 0;
    for (; u + kPixels <= gray.cols; u += kPixels) smooth(above + u, row + u, below + u, sums + u);
    for (; u < gray.cols; ++u)
      sums[u] = static_cast<std::uint16_t>(above[u] + 6 * row[u] + below[u]);
    sums[-1] = sums[0];
    sums[gray.cols] = sums[gray.cols - 1];
    auto* out = image.ptr<std::uint16_t>(v);
    for (u = 0; u + kPixels <= gray.cols; u += kPixels)
      smooth(sums + u - 1, sums + u, sums + u + 1, out + u);
    for (; u < gray.cols; ++u)
      out[u] = static_cast<std::uint16_t>(sums[u - 1] + 6 * sums[u] + sums[u + 1]);
  }
}

[[gnu::always_inline]] inline void halve_rows(const cv::Mat& image, cv::Mat& half) {
  for (int v = 0; v < half.rows; ++v) {
    const auto* upper = image.ptr<std::uint16_t>(2 * v);
    const auto* lower = image.ptr<std::uint16_t>(2 * v + 1);
    auto* out = half.ptr<std::uint16_t>(v);
    int u = 0;
    // Four times 255 * 64 are below 2^16.
    for (; u + kPixels / 2 <= half.cols; u += kPixels / 2) {
      SmoothedPixels a, b;
      load(upper + 2 * u, a);
      load(lower + 2 * u, b);
      const auto sums = (TwoRowSums)(a + b);
      const TwoRowSums fours = (sums & 0xffffU) + (sums >> 16U);
      const EightMeans means = __builtin_convertvector(fours >> 2U, EightMeans);
      std::memcpy(out + u, &means, sizeof(means));
    }
    for (; u < half.cols; ++u) {
      const int k = 2 * u;
      out[u] = static_cast<std::uint16_t>((upper[k] + upper[k + 1] + lower[k] + lower[k + 1]) / 4);
    }
  }
}

void smooth_baseline(const cv::Mat& gray, cv::Mat& image) { smooth_rows(gray, image); }
void halve_baseline(const cv::Mat& image, cv::Mat& half) { halve_rows(image, half); }
GPO_AVX2_FMA void smooth_avx2_fma(const cv::Mat& gray, cv::Mat& image) { smooth_rows(gray, image); }
GPO_AVX2_FMA void halve_avx2_fma(const cv::Mat& image, cv::Mat& half) { halve_rows(image, half); }

constexpr int kLeastSide_px = 24;  // side of the smallest image

}  // namespace

cv::Mat smooth_image(const cv::Mat& gray) {
  static const auto version = has_avx2_fma() ? smooth_avx2_fma : smooth_baseline;
  cv::Mat image(gray.size(), CV_16UC1);
  version(gray, image);
  return image;
}

cv::Mat halved(const cv::Mat& image) {
  static const auto version = has_avx2_fma() ? halve_avx2_fma : halve_baseline;
  cv::Mat half(image.rows / 2, image.cols / 2, CV_16UC1);
  version(image, half);
  return half;
}

SmoothedPyramid smoothed_pyramid(const cv::Mat& gray) {
  SmoothedPyramid pyramid{smooth_image(gray)};
  while (std::min(pyramid.back().cols, pyramid.back().rows) / 2 >= kLeastSide_px)
    pyramid.push_back(halved(pyramid.back()));
  return pyramid;
}

}  // namespace gpo
