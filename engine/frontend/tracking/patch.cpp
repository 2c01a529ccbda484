// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/patch.h"

#include "engine/base/processor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace gpo {
namespace {

constexpr double kRounding_px = 0.01;  // more than the rounding of floats

using Column = Eigen::Map<Eigen::ArrayXf>;
using ConstColumn = Eigen::Map<const Eigen::ArrayXf>;

ConstColumn column(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

std::array<std::vector<float>*, 6> columns_of(Patch& patch) {
  return {&patch.dx, &patch.dy, &patch.slope_x, &patch.slope_y, &patch.brightness, &patch.one};
}

void add_pixel(const cv::Mat& image, const cv::Point& middle, const cv::Point& d, Patch& patch) {
  const cv::Point p = middle + d;
  const bool inside = p.x >= 1 && p.y >= 1 && p.x < image.cols - 1 && p.y < image.rows - 1;
  const auto at = [&](int u, int v) {
    return inside ? static_cast<float>(image.at<std::uint16_t>(p.y + v, p.x + u)) : 0.0F;
  };
  patch.dx.push_back(static_cast<float>(d.x));
  patch.dy.push_back(static_cast<float>(d.y));
  patch.slope_x.push_back((at(1, 0) - at(-1, 0)) / 2);
  patch.slope_y.push_back((at(0, 1) - at(0, -1)) / 2);
  patch.brightness.push_back(at(0, 0));
  patch.one.push_back(inside ? 1 : 0);
}

/// Returns the largest distance along x and y of a warped template from the warp's center [px].
Eigen::Vector2d reach_px(const Patch& patch, const Warp& warp) {
  return patch.half * warp.linear.cwiseAbs().rowwise().sum() +
         patch.half * patch.half * warp.quadratic.cwiseAbs().rowwise().sum();
}

// Eight numbers: one register of AVX2, two of the baseline. One long body, as in plane_kernel.cpp.
using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using PixelPairs =
    std::uint32_t __attribute__((vector_size(32)));  // a pixel and the one to its right
static_assert(sizeof(Floats) == kPatchKernelWidth * sizeof(float));

// NOLINTNEXTLINE(readability-function-size): see plane_kernel.cpp
[[gnu::always_inline]] inline PatchSums accumulate(const cv::Mat& image,
                                                   const Patch& patch,
                                                   const Warp& warp) {
  // Relative to a nearby whole pixel: in large images floats resolve only a thousandth of a pixel.
  const Eigen::Vector2d reach = reach_px(patch, warp);
  const int first_u = std::max(0, static_cast<int>(std::floor(warp.center.x() - reach.x())));
  const int first_v = std::max(0, static_cast<int>(std::floor(warp.center.y() - reach.y())));
  const auto stride = static_cast<int>(image.step1());
  const auto* first = image.ptr<std::uint16_t>(first_v) + first_u;
  const auto x0 = static_cast<float>(warp.center.x() - first_u);
  const auto y0 = static_cast<float>(warp.center.y() - first_v);
  const Eigen::Matrix2f A = warp.linear.cast<float>();
  const Eigen::Matrix<float, 2, 3> Q = warp.quadratic.cast<float>();
  const auto two = [first](int offset) {
    std::uint32_t pixels = 0;
    std::memcpy(&pixels, first + offset, sizeof(pixels));
    return pixels;
  };
  Floats sum[8] = {};
  Floats squares = {};
  for (std::size_t k = 0; k < patch.dx.size(); k += kPatchKernelWidth) {
    Floats dx, dy, gx, gy, T, one;
    std::memcpy(&dx, &patch.dx[k], sizeof(Floats));
    std::memcpy(&dy, &patch.dy[k], sizeof(Floats));
    std::memcpy(&gx, &patch.slope_x[k], sizeof(Floats));
    std::memcpy(&gy, &patch.slope_y[k], sizeof(Floats));
    std::memcpy(&T, &patch.brightness[k], sizeof(Floats));
    std::memcpy(&one, &patch.one[k], sizeof(Floats));
    const Floats xx = dx * dx;
    const Floats xy = dx * dy;
    const Floats yy = dy * dy;
    const Floats x = x0 + A(0, 0) * dx + A(0, 1) * dy + Q(0, 0) * xx + Q(0, 1) * xy + Q(0, 2) * yy;
    const Floats y = y0 + A(1, 0) * dx + A(1, 1) * dy + Q(1, 0) * xx + Q(1, 1) * xy + Q(1, 2) * yy;
    const Ints u = __builtin_convertvector(x, Ints);
    const Ints v = __builtin_convertvector(y, Ints);
    const Ints o = v * stride + u;
    const Ints p = o + stride;
    const PixelPairs upper = {
        two(o[0]), two(o[1]), two(o[2]), two(o[3]), two(o[4]), two(o[5]), two(o[6]), two(o[7])};
    const PixelPairs lower = {
        two(p[0]), two(p[1]), two(p[2]), two(p[3]), two(p[4]), two(p[5]), two(p[6]), two(p[7])};
    const Floats a = x - __builtin_convertvector(u, Floats);
    const Floats b = y - __builtin_convertvector(v, Floats);
    const Floats upper_left = __builtin_convertvector((Ints)(upper & 0xffffU), Floats);
    const Floats upper_right = __builtin_convertvector((Ints)(upper >> 16U), Floats);
    const Floats lower_left = __builtin_convertvector((Ints)(lower & 0xffffU), Floats);
    const Floats lower_right = __builtin_convertvector((Ints)(lower >> 16U), Floats);
    const Floats top = upper_left + a * (upper_right - upper_left);
    const Floats bottom = lower_left + a * (lower_right - lower_left);
    const Floats I = (top + b * (bottom - top)) * one;
    const Floats gxI = gx * I;
    const Floats gyI = gy * I;
    sum[0] += gxI;
    sum[1] += gyI;
    sum[2] += gxI * dx;
    sum[3] += gxI * dy;
    sum[4] += gyI * dx;
    sum[5] += gyI * dy;
    sum[6] += T * I;
    sum[7] += I;
    squares += I * I;
  }
  PatchSums sums;
  for (int k = 0; k < kPatchKernelWidth; ++k) {
    for (int i = 0; i < 8; ++i) sums.products[i] += sum[i][k];
    sums.squares += squares[k];
  }
  return sums;
}

[[gnu::always_inline]] inline PatchSums accumulate_shifted(const cv::Mat& image,
                                                           const Patch& patch,
                                                           const Eigen::Vector2d& center) {
  using Pixels = std::uint16_t __attribute__((vector_size(16)));
  const int middle_u = static_cast<int>(std::floor(center.x()));
  const int middle_v = static_cast<int>(std::floor(center.y()));
  const auto a = static_cast<float>(center.x() - middle_u);
  const auto b = static_cast<float>(center.y() - middle_v);
  const auto stride = static_cast<std::ptrdiff_t>(image.step1());
  const auto* middle = image.ptr<std::uint16_t>(middle_v) + middle_u;
  Floats sum[4] = {};
  Floats squares = {};
  for (std::size_t k = 0; k < patch.dx.size(); k += kPatchKernelWidth) {
    const auto* first = middle + static_cast<std::ptrdiff_t>(patch.dy[k]) * stride +
                        static_cast<std::ptrdiff_t>(patch.dx[k]);
    Pixels corner[4];
    std::memcpy(&corner[0], first, sizeof(Pixels));
    std::memcpy(&corner[1], first + 1, sizeof(Pixels));
    std::memcpy(&corner[2], first + stride, sizeof(Pixels));
    std::memcpy(&corner[3], first + stride + 1, sizeof(Pixels));
    Floats gx, gy, T;
    std::memcpy(&gx, &patch.slope_x[k], sizeof(Floats));
    std::memcpy(&gy, &patch.slope_y[k], sizeof(Floats));
    std::memcpy(&T, &patch.brightness[k], sizeof(Floats));
    const Floats upper_left = __builtin_convertvector(corner[0], Floats);
    const Floats upper_right = __builtin_convertvector(corner[1], Floats);
    const Floats lower_left = __builtin_convertvector(corner[2], Floats);
    const Floats lower_right = __builtin_convertvector(corner[3], Floats);
    const Floats top = upper_left + a * (upper_right - upper_left);
    const Floats bottom = lower_left + a * (lower_right - lower_left);
    const Floats I = top + b * (bottom - top);
    sum[0] += gx * I;
    sum[1] += gy * I;
    sum[2] += T * I;
    sum[3] += I;
    squares += I * I;
  }
  PatchSums sums;
  for (int k = 0; k < kPatchKernelWidth; ++k) {
    sums.products[0] += sum[0][k];
    sums.products[1] += sum[1][k];
    sums.products[6] += sum[2][k];
    sums.products[7] += sum[3][k];
    sums.squares += squares[k];
  }
  return sums;
}

}  // namespace

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

Patch make_patch(const cv::Mat& image, const cv::Point& middle, int half) {
  Patch patch;
  patch.half = half;
  for (int v = -half; v <= half; ++v)
    for (int u = -half; u <= half; ++u) add_pixel(image, middle, {u, v}, patch);
  const std::size_t padded =
      (patch.dx.size() + kPatchKernelWidth - 1) / kPatchKernelWidth * kPatchKernelWidth;
  for (auto* values : columns_of(patch)) values->resize(padded, 0.0F);
  const float pixels = column(patch.one).sum();
  Column brightness(patch.brightness.data(), static_cast<Eigen::Index>(padded));
  if (pixels > 0) brightness -= brightness.sum() / pixels * column(patch.one);
  return patch;
}

PatchNormalMatrix patch_normal_matrix(const Patch& patch) {
  const ConstColumn dx = column(patch.dx);
  const ConstColumn dy = column(patch.dy);
  const ConstColumn gx = column(patch.slope_x);
  const ConstColumn gy = column(patch.slope_y);
  Eigen::Matrix<float, Eigen::Dynamic, 8> columns(dx.size(), 8);
  columns << gx, gy, gx * dx, gx * dy, gy * dx, gy * dy, column(patch.brightness),
      column(patch.one);
  return (columns.transpose() * columns).cast<double>();
}

bool is_inside(const cv::Size& image, const Patch& patch, const Warp& warp) {
  const Eigen::Vector2d reach = reach_px(patch, warp).array() + kRounding_px;
  return warp.center.x() - reach.x() >= 0 && warp.center.y() - reach.y() >= 0 &&
         warp.center.x() + reach.x() < image.width - 1 &&
         warp.center.y() + reach.y() < image.height - 1;
}

Patch inside_part(const cv::Size& image, const Patch& patch, const Warp& warp) {
  Patch part = patch;
  for (std::size_t k = 0; k < part.dx.size(); ++k) {
    const Eigen::Vector2d px = warp(Eigen::Vector2d(part.dx[k], part.dy[k]));
    if (px.minCoeff() >= kRounding_px && px.x() < image.width - 1 - kRounding_px &&
        px.y() < image.height - 1 - kRounding_px)
      continue;
    for (auto* values : columns_of(part)) (*values)[k] = 0;
  }
  return part;
}

PatchSums patch_sums_baseline(const cv::Mat& image, const Patch& patch, const Warp& warp) {
  return accumulate(image, patch, warp);
}

GPO_AVX2_FMA PatchSums patch_sums_avx2_fma(const cv::Mat& image,
                                           const Patch& patch,
                                           const Warp& warp) {
  return accumulate(image, patch, warp);
}

PatchSums patch_sums(const cv::Mat& image, const Patch& patch, const Warp& warp) {
  static const auto version = has_avx2_fma() ? patch_sums_avx2_fma : patch_sums_baseline;
  return version(image, patch, warp);
}

PatchSums shifted_sums_baseline(const cv::Mat& image,
                                const Patch& patch,
                                const Eigen::Vector2d& center) {
  return accumulate_shifted(image, patch, center);
}

GPO_AVX2_FMA PatchSums shifted_sums_avx2_fma(const cv::Mat& image,
                                             const Patch& patch,
                                             const Eigen::Vector2d& center) {
  return accumulate_shifted(image, patch, center);
}

PatchSums shifted_sums(const cv::Mat& image, const Patch& patch, const Eigen::Vector2d& center) {
  static const auto version = has_avx2_fma() ? shifted_sums_avx2_fma : shifted_sums_baseline;
  return version(image, patch, center);
}

}  // namespace gpo
