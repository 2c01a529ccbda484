// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/patch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector4d;

constexpr int kHalf = 8;            // half the side of a patch [px]
constexpr int kFarthest = 6;        // global motion [px of the smallest image]
constexpr int kMostSteps = 8;       // Gauss-Newton steps on a level
constexpr double kConverged = 0.1;  // length of its last step [px of the level]
constexpr double kAnyDistance = std::numeric_limits<double>::infinity();
constexpr int kMostDeviation = 32 * 64;  // squares of a row's differences fit into 32 bits

Patch empty_patch() {
  Patch patch;
  patch.half = kHalf;
  patch.row = 2 * kHalf;
  for (int v = -kHalf; v < kHalf; ++v) {
    for (int u = -kHalf; u < kHalf; ++u) {
      patch.dx.push_back(static_cast<float>(u));
      patch.dy.push_back(static_cast<float>(v));
    }
  }
  for (auto* values : {&patch.slope_x, &patch.slope_y, &patch.brightness})
    values->resize(patch.dx.size());
  patch.one.assign(patch.dx.size(), 1);
  return patch;
}

// Eight numbers: one register of AVX2, two of the baseline.
using Pixels = std::uint16_t __attribute__((vector_size(16)));
using EightDeviations = std::int16_t __attribute__((vector_size(16)));
using EightSums = std::int32_t __attribute__((vector_size(32)));
constexpr int kAtATime = 8;
using EightFloats = float __attribute__((vector_size(32)));
static_assert(kAtATime == kPatchKernelWidth);

[[gnu::always_inline]] inline double sum_of(const EightFloats& values) {
  double sum = 0;
  for (int k = 0; k < kAtATime; ++k) sum += values[k];
  return sum;
}

/// Subtracts eight pixels, which are below 2^15.
[[gnu::always_inline]] inline void subtract(const std::uint16_t* from,
                                            const std::uint16_t* pixels,
                                            EightFloats& values) {
  Pixels a, b;
  std::memcpy(&a, from, sizeof(a));
  std::memcpy(&b, pixels, sizeof(b));
  values = __builtin_convertvector(__builtin_convertvector((EightDeviations)(a - b), EightSums),
                                   EightFloats);
}

[[gnu::always_inline]] inline Eigen::Matrix4d take(const cv::Mat& image,
                                                   const cv::Point& middle,
                                                   Patch& patch) {
  const auto stride = static_cast<std::ptrdiff_t>(image.step1());
  std::uint16_t offset[kAtATime];  // small sums have small rounding errors
  std::fill_n(offset, kAtATime, image.at<std::uint16_t>(middle));
  const int rows = static_cast<int>(patch.dx.size()) / patch.row;
  EightFloats xx = {}, xy = {}, yy = {}, xT = {}, yT = {}, TT = {}, x = {}, y = {}, t = {};
  std::size_t k = 0;
  for (int row = 0; row < rows; ++row) {
    const auto* pixels =
        image.ptr<std::uint16_t>(middle.y - patch.half + row) + middle.x - patch.half;
    for (int column = 0; column < patch.row; column += kAtATime, k += kAtATime) {
      const auto* here = pixels + column;
      EightFloats T, gx, gy;
      subtract(here, offset, T);
      subtract(here + 1, here - 1, gx);
      subtract(here + stride, here - stride, gy);
      gx *= 0.5F;
      gy *= 0.5F;
      std::memcpy(&patch.brightness[k], &T, sizeof(EightFloats));
      std::memcpy(&patch.slope_x[k], &gx, sizeof(EightFloats));
      std::memcpy(&patch.slope_y[k], &gy, sizeof(EightFloats));
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
      xT += gx * T;
      yT += gy * T;
      TT += T * T;
      x += gx;
      y += gy;
      t += T;
    }
  }
  const double n = rows * patch.row;
  const double sum = sum_of(t);
  const auto mean = static_cast<float>(sum / n);
  for (k = 0; k < patch.brightness.size(); k += kAtATime) {
    EightFloats T;
    std::memcpy(&T, &patch.brightness[k], sizeof(EightFloats));
    T -= mean;
    std::memcpy(&patch.brightness[k], &T, sizeof(EightFloats));
  }
  Eigen::Matrix4d normal;
  normal.row(0) << sum_of(xx), sum_of(xy), sum_of(xT) - sum / n * sum_of(x), sum_of(x);
  normal.row(1) << normal(0, 1), sum_of(yy), sum_of(yT) - sum / n * sum_of(y), sum_of(y);
  normal.row(2) << normal(0, 2), normal(1, 2), sum_of(TT) - sum / n * sum, 0;
  normal.row(3) << normal(0, 3), normal(1, 3), 0, n;
  return normal;
}

GPO_AVX2_FMA Eigen::Matrix4d take_avx2_fma(const cv::Mat& image,
                                           const cv::Point& middle,
                                           Patch& patch) {
  return take(image, middle, patch);
}

struct PatchMotion {
  Vector2d px;
  double correlation = -1;
};

/// Returns the motion of the patch around `from_px` on a level, or `guess_px` if none fits better.
PatchMotion moved(const cv::Mat& from,
                  const cv::Mat& to,
                  const Vector2d& from_px,
                  const Vector2d& guess_px,
                  Patch& patch) {
  // Near the image border, use the nearest patch that is inside of both images.
  const Vector2d least = (Vector2d::Constant(kHalf + 1) - guess_px).cwiseMax(kHalf + 1);
  const Vector2d most =
      (Vector2d(from.cols, from.rows) - Vector2d::Constant(kHalf + 3))
          .cwiseMin(Vector2d(from.cols, from.rows) - guess_px - Vector2d::Constant(kHalf + 3));
  const Vector2d middle = from_px.cwiseMax(least.array().ceil().matrix())
                              .cwiseMin(most.array().floor().matrix())
                              .array()
                              .round();
  if (!((middle - least).minCoeff() >= 0)) return {guess_px};
  const Matrix4d normal =
      take_pixels(from, {static_cast<int>(middle.x()), static_cast<int>(middle.y())}, patch);
  Matrix4d inverse = normal.inverse();
  if (!inverse.allFinite()) inverse = Eigen::LDLT<Matrix4d>(normal).solve(Matrix4d::Identity());
  const double n = normal(3, 3);
  Vector2d moved_px = guess_px;
  PatchMotion best{guess_px};
  for (int step = 0; step < kMostSteps; ++step) {
    const Warp warp{middle + moved_px};
    if (!is_inside(to.size(), patch, warp)) break;
    const PatchSums sums = shifted_sums(to, patch, warp.center);
    const Vector4d b(sums.products[0], sums.products[1], sums.products[6], sums.products[7]);
    const double variances = (sums.squares - b[3] * b[3] / n) * normal(2, 2);
    const double correlation = variances > 0 ? b[2] / std::sqrt(variances) : 0;
    if (correlation > best.correlation) best = {moved_px, correlation};
    const Vector4d solution = inverse * b;
    if (!(solution[2] > 0)) break;
    const Vector2d step_px = -solution.head<2>() / solution[2];
    if (!(step_px.norm() < kHalf)) break;
    moved_px += step_px;
    if (step_px.norm() < kConverged) return {moved_px, correlation};
  }
  return best;
}

/// Returns deviations from the mean in 64ths of the standard deviation, invariant to gain and
/// offset of the exposure, at most `kMostDeviation`, CV_16SC1. Sums of integers do not depend on
/// their order.
cv::Mat standardized(const cv::Mat& image) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  const double scale = deviation[0] > 0 ? 64 / deviation[0] : 0;
  cv::Mat result;
  image.convertTo(result, CV_16S, scale, -scale * mean[0]);
  return cv::min(cv::max(result, -kMostDeviation), kMostDeviation);
}

/// Returns the mean squared difference of two images of deviations, one of which is shifted.
[[gnu::always_inline]] inline double difference(const cv::Mat& from,
                                                const cv::Mat& to,
                                                const cv::Point& by) {
  const cv::Rect common = cv::Rect({0, 0}, to.size()) & cv::Rect(by, from.size());
  std::int64_t sum = 0;
  for (int v = common.y; v < common.y + common.height; ++v) {
    const auto* a = from.ptr<std::int16_t>(v - by.y) + common.x - by.x;
    const auto* b = to.ptr<std::int16_t>(v) + common.x;
    EightSums sums = {};
    int u = 0;
    for (; u + kAtATime <= common.width; u += kAtATime) {
      EightDeviations x, y;
      std::memcpy(&x, a + u, sizeof(x));
      std::memcpy(&y, b + u, sizeof(y));
      const EightSums off = __builtin_convertvector(x - y, EightSums);
      sums += off * off;
    }
    for (; u < common.width; ++u) sum += (a[u] - b[u]) * (a[u] - b[u]);
    for (int k = 0; k < kAtATime; ++k) sum += sums[k];
  }
  return static_cast<double>(sum) / common.area();
}

GPO_AVX2_FMA double difference_avx2_fma(const cv::Mat& from,
                                        const cv::Mat& to,
                                        const cv::Point& by) {
  return difference(from, to, by);
}

/// Estimates the motion of the whole image. Without it a jolt would lose places near the border.
Vector2d global_motion(const cv::Mat& from, const cv::Mat& to) {
  const cv::Mat a = standardized(from);
  const cv::Mat b = standardized(to);
  const int farthest = std::min({kFarthest, from.cols / 3, from.rows / 3});
  cv::Point best(0, 0);
  const auto difference_at = [&, avx2_fma = has_avx2_fma()](const cv::Point& by) {
    return avx2_fma ? difference_avx2_fma(a, b, by) : difference(a, b, by);
  };
  double least = difference_at(best);
  for (int v = -farthest; v <= farthest; ++v) {
    for (int u = -farthest; u <= farthest; ++u) {
      const double now = difference_at({u, v});
      if (now < least) {
        least = now;
        best = {u, v};
      }
    }
  }
  return {best.x, best.y};
}

}  // namespace

Eigen::Matrix4d take_pixels(const cv::Mat& image,
                            const cv::Point& middle,
                            Patch& patch,
                            bool avx2_fma) {
  return avx2_fma ? take_avx2_fma(image, middle, patch) : take(image, middle, patch);
}

PlaceMotions refined_motions(const SmoothedPyramid& from,
                             const SmoothedPyramid& to,
                             const Eigen::Matrix2Xd& raw_px,
                             const Eigen::Matrix2Xd& start_px,
                             const std::vector<int>& levels,
                             const Eigen::VectorXd& farthest_px) {
  Patch patch = empty_patch();
  PlaceMotions motions{start_px, Eigen::VectorXd::Constant(raw_px.cols(), -1)};
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) {
    for (int now = levels[j]; now >= 1; --now) {
      const double scale = std::ldexp(1.0, -now);
      // The center of a level's first pixel is the center of four pixels of the finer level.
      const Vector2d px = scale * (raw_px.col(j).array() + 0.5) - 0.5;
      const auto [moved_px, correlation] =
          moved(from[now], to[now], px, scale * motions.px.col(j), patch);
      const bool near = (moved_px / scale - start_px.col(j)).norm() <= farthest_px[j];
      if (near) motions.px.col(j) = moved_px / scale;
      motions.correlations[j] = near ? correlation : -1;
    }
  }
  return motions;
}

double farthest_motion_px(const SmoothedPyramid& pyramid) {
  return std::ldexp(kFarthest, static_cast<int>(pyramid.size()) - 1);
}

Eigen::Matrix2Xd coarse_flow(const SmoothedPyramid& from,
                             const SmoothedPyramid& to,
                             const Eigen::Matrix2Xd& raw_px) {
  const int level = static_cast<int>(from.size()) - 1;
  const Vector2d start = global_motion(from.back(), to.back()) * std::ldexp(1.0, level);
  const auto anywhere = Eigen::VectorXd::Constant(raw_px.cols(), kAnyDistance);
  const std::vector<int> levels(raw_px.cols(), level);
  return refined_motions(from, to, raw_px, start.replicate(1, raw_px.cols()), levels, anywhere).px;
}

}  // namespace gpo
