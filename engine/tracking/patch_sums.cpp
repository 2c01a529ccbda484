// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/patch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace gpo {
namespace {

// Eight numbers: one register of AVX2, two of the baseline. One long body, as in plane_kernel.cpp.
using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using EightPixels = std::uint16_t __attribute__((vector_size(16)));
using PixelPairs =
    std::uint32_t __attribute__((vector_size(32)));  // a pixel and the one to its right
static_assert(sizeof(Floats) == kPatchKernelWidth * sizeof(float));

/// Whole pixel near the first one of a warped template, and the warp in single precision from it:
/// in large images floats resolve only a thousandth of a pixel.
struct Origin {
  const std::uint16_t* first;
  int stride;
  float x0, y0;
  Eigen::Matrix2f A;
  Eigen::Matrix<float, 2, 3> Q;
};

Origin origin_of(const cv::Mat& image, const Patch& patch, const Warp& warp, int margin_px) {
  const Eigen::Vector2d reach = reach_px(patch, warp).array() + margin_px;
  const int first_u = std::max(0, static_cast<int>(std::floor(warp.center.x() - reach.x())));
  const int first_v = std::max(0, static_cast<int>(std::floor(warp.center.y() - reach.y())));
  return {.first = image.ptr<std::uint16_t>(first_v) + first_u,
          .stride = static_cast<int>(image.step1()),
          .x0 = static_cast<float>(warp.center.x() - first_u),
          .y0 = static_cast<float>(warp.center.y() - first_v),
          .A = warp.linear.cast<float>(),
          .Q = warp.quadratic.cast<float>()};
}

[[gnu::always_inline]] inline float total(const Floats& values) {
  float sum = 0;
  for (int k = 0; k < kPatchKernelWidth; ++k) sum += values[k];
  return sum;
}

/// Interpolates between eight pixels and those to their right.
[[gnu::always_inline]] inline void interpolate(const std::uint16_t* pixels,
                                               float a,
                                               Floats& values) {
  EightPixels left, right;
  std::memcpy(&left, pixels, sizeof(left));
  std::memcpy(&right, pixels + 1, sizeof(right));
  values = __builtin_convertvector(left, Floats);
  values += a * (__builtin_convertvector(right, Floats) - values);
}

/// Interpolates within eight pairs of pixels.
[[gnu::always_inline]] inline void interpolate(const PixelPairs& pairs,
                                               const Floats& a,
                                               Floats& values) {
  values = __builtin_convertvector((Ints)(pairs & 0xffffU), Floats);
  values += a * (__builtin_convertvector((Ints)(pairs >> 16U), Floats) - values);
}

[[gnu::always_inline]] inline PatchSums sums_of(const Floats (&products)[8],
                                                const Floats& squares) {
  PatchSums sums;
  for (int i = 0; i < 8; ++i) sums.products[i] = total(products[i]);
  sums.squares = total(squares);
  return sums;
}

// NOLINTNEXTLINE(readability-function-size): see plane_kernel.cpp
[[gnu::always_inline]] inline PatchSums accumulate(const cv::Mat& image,
                                                   const Patch& patch,
                                                   const Warp& warp) {
  const auto [first, stride, x0, y0, A, Q] = origin_of(image, patch, warp, 0);
  const auto two = [pixel = first](int offset) {
    std::uint32_t pixels = 0;
    std::memcpy(&pixels, pixel + offset, sizeof(pixels));
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
    Floats top, bottom;
    interpolate(upper, a, top);
    interpolate(lower, a, bottom);
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
  return sums_of(sum, squares);
}

#ifdef __x86_64__

constexpr int kMargin_px = 16;      // pixels around a template that are read, too
constexpr int kMostColumns = 4;     // columns of eight pixels
constexpr float kSlack_px = 0.001;  // more than the rounding of floats in a template

/// Returns how a row's y changes at most from a pixel to the next: least and largest [px].
Eigen::Vector2d slopes_along_rows(const Patch& patch, const Warp& warp, int axis) {
  const int half = patch.half + kPatchKernelWidth;
  const double bend =
      half * (2 * std::abs(warp.quadratic(axis, 0)) + std::abs(warp.quadratic(axis, 1)));
  return {warp.linear(axis, 0) - bend, warp.linear(axis, 0) + bend};
}

/// Returns whether a template is complete, and any four neighbors of a row are interpolated from
/// three rows of eight pixels that begin at the first of the four, all of them in the image.
bool is_gentle(const cv::Size& image, const Patch& patch, const Warp& warp) {
  const Eigen::Vector2d x = slopes_along_rows(patch, warp, 0);
  const Eigen::Vector2d y = slopes_along_rows(patch, warp, 1);
  const Eigen::Vector2d reach = reach_px(patch, warp).array() + kMargin_px;
  return patch.is_complete && patch.row <= kMostColumns * kPatchKernelWidth && x[0] > 0.1 &&
         x[1] < 1.9 && 3 * (std::max(y[1], 0.0) - std::min(y[0], 0.0)) < 0.99 &&
         (warp.center.array() > reach.array()).all() &&
         warp.center.x() + reach.x() < image.width - 1 &&
         warp.center.y() + reach.y() < image.height - 1;
}

/// The same as `accumulate` for a warp that `is_gentle`, by whole rows of the template. Eight
/// pixels are gathered from registers instead of memory.
template <bool kShift>  // NOLINTNEXTLINE(readability-function-size): see plane_kernel.cpp
GPO_AVX2_FMA PatchSums accumulate_rows(const cv::Mat& image, const Patch& patch, const Warp& warp) {
  const auto [first, stride, x0, y0, A, Q] = origin_of(image, patch, warp, kMargin_px);
  Floats column_dx[kMostColumns];
  Ints column_mask[kMostColumns];  // without padding
  for (int c = 0; c < patch.row / kPatchKernelWidth; ++c) {
    const Ints columns = Ints{0, 1, 2, 3, 4, 5, 6, 7} + (c * kPatchKernelWidth - patch.half);
    column_dx[c] = __builtin_convertvector(columns, Floats);
    column_mask[c] = columns <= patch.half;
  }
  const auto above = static_cast<float>(std::min(0.0, 3 * slopes_along_rows(patch, warp, 1)[0]));
  Floats sum[8] = {};
  Floats squares = {};
  std::size_t k = 0;
  for (int row = -patch.half; row <= patch.half; ++row) {
    const auto dy = static_cast<float>(row);
    const float row_x = x0 + dy * (A(0, 1) + dy * Q(0, 2));
    const float row_y = y0 + dy * (A(1, 1) + dy * Q(1, 2));
    const float slope_x = A(0, 0) + dy * Q(0, 1);
    const float slope_y = A(1, 0) + dy * Q(1, 1);
    Floats row_gxI = {};
    Floats row_gyI = {};
    for (int c = 0; c < patch.row / kPatchKernelWidth; ++c, k += kPatchKernelWidth) {
      Floats gx, gy, T;
      std::memcpy(&gx, &patch.slope_x[k], sizeof(Floats));
      std::memcpy(&gy, &patch.slope_y[k], sizeof(Floats));
      std::memcpy(&T, &patch.brightness[k], sizeof(Floats));
      const Floats dx = column_dx[c];
      const Floats x = row_x + dx * (slope_x + dx * Q(0, 0));
      const Floats y = row_y + dx * (slope_y + dx * Q(1, 0));
      const Ints u = __builtin_convertvector(x, Ints);
      const Ints v = __builtin_convertvector(y, Ints);
      // First pixel and row of each four.
      const auto first_u = (Ints)_mm256_shuffle_epi32((__m256i)u, 0);
      const Ints least_v = __builtin_convertvector(y + (above - kSlack_px), Ints);
      const auto first_v = (Ints)_mm256_shuffle_epi32((__m256i)least_v, 0);
      const Ints o = first_v * stride + first_u;
      const std::uint16_t* left = first + o[0];
      const std::uint16_t* right = first + o[4];
      const __m256i pairs =
          (__m256i)((u - first_u) * 0x02020202 + 0x03020100);  // bytes of a pixel and the next
      __m256i rows[3];
#pragma GCC unroll 3
      for (int down = 0; down < 3; ++down, left += stride, right += stride)
        rows[down] =
            _mm256_shuffle_epi8(_mm256_loadu2_m128i(reinterpret_cast<const __m128i*>(right),
                                                    reinterpret_cast<const __m128i*>(left)),
                                pairs);
      const auto below = (__m256i)(v > first_v);
      const auto upper = (PixelPairs)_mm256_blendv_epi8(rows[0], rows[1], below);
      const auto lower = (PixelPairs)_mm256_blendv_epi8(rows[1], rows[2], below);
      const Floats a = x - __builtin_convertvector(u, Floats);
      const Floats b = y - __builtin_convertvector(v, Floats);
      Floats top, bottom;
      interpolate(upper, a, top);
      interpolate(lower, a, bottom);
      const auto I = (Floats)((Ints)(top + b * (bottom - top)) & column_mask[c]);
      row_gxI += gx * I;
      row_gyI += gy * I;
      if constexpr (!kShift) {
        sum[2] += gx * I * dx;
        sum[4] += gy * I * dx;
      }
      sum[6] += T * I;
      sum[7] += I;
      squares += I * I;
    }
    sum[0] += row_gxI;
    sum[1] += row_gyI;
    if constexpr (!kShift) {
      sum[3] += row_gxI * dy;
      sum[5] += row_gyI * dy;
    }
  }
  return sums_of(sum, squares);
}

#endif

/// Goes through columns of eight pixels, so that each row of the image is interpolated once.
[[gnu::always_inline]] inline PatchSums accumulate_shifted(const cv::Mat& image,
                                                           const Patch& patch,
                                                           const Eigen::Vector2d& center) {
  const int middle_u = static_cast<int>(std::floor(center.x()));
  const int middle_v = static_cast<int>(std::floor(center.y()));
  const auto a = static_cast<float>(center.x() - middle_u);
  const auto b = static_cast<float>(center.y() - middle_v);
  const auto stride = static_cast<std::ptrdiff_t>(image.step1());
  const int rows = static_cast<int>(patch.dx.size()) / patch.row;
  Floats sum[4] = {};
  Floats squares = {};
  for (int column = 0; column < patch.row; column += kPatchKernelWidth) {
    const auto* pixels =
        image.ptr<std::uint16_t>(middle_v - patch.half) + middle_u - patch.half + column;
    Floats top, bottom;
    interpolate(pixels, a, top);
    for (int row = 0; row < rows; ++row) {
      pixels += stride;
      interpolate(pixels, a, bottom);
      Floats gx, gy, T;
      const std::size_t k = row * patch.row + column;
      std::memcpy(&gx, &patch.slope_x[k], sizeof(Floats));
      std::memcpy(&gy, &patch.slope_y[k], sizeof(Floats));
      std::memcpy(&T, &patch.brightness[k], sizeof(Floats));
      const Floats I = top + b * (bottom - top);
      sum[0] += gx * I;
      sum[1] += gy * I;
      sum[2] += T * I;
      sum[3] += I;
      squares += I * I;
      top = bottom;
    }
  }
  PatchSums sums;
  sums.products[0] = total(sum[0]);
  sums.products[1] = total(sum[1]);
  sums.products[6] = total(sum[2]);
  sums.products[7] = total(sum[3]);
  sums.squares = total(squares);
  return sums;
}

GPO_AVX2_FMA PatchSums patch_sums_avx2_fma(const cv::Mat& image,
                                           const Patch& patch,
                                           const Warp& warp,
                                           [[maybe_unused]] MotionModel unknown) {
#ifdef __x86_64__
  if (is_gentle(image.size(), patch, warp))
    return unknown == MotionModel::shift ? accumulate_rows<true>(image, patch, warp)
                                         : accumulate_rows<false>(image, patch, warp);
#endif
  return accumulate(image, patch, warp);
}

GPO_AVX2_FMA PatchSums shifted_sums_avx2_fma(const cv::Mat& image,
                                             const Patch& patch,
                                             const Eigen::Vector2d& center) {
  return accumulate_shifted(image, patch, center);
}

}  // namespace

PatchSums patch_sums(const cv::Mat& image,
                     const Patch& patch,
                     const Warp& warp,
                     MotionModel unknown,
                     bool avx2_fma) {
  return avx2_fma ? patch_sums_avx2_fma(image, patch, warp, unknown)
                  : accumulate(image, patch, warp);
}

PatchSums shifted_sums(const cv::Mat& image,
                       const Patch& patch,
                       const Eigen::Vector2d& center,
                       bool avx2_fma) {
  return avx2_fma ? shifted_sums_avx2_fma(image, patch, center)
                  : accumulate_shifted(image, patch, center);
}

}  // namespace gpo
