// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/patch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>

namespace gpo {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector4d;

constexpr int kCoarsest = 4;        // 1/16 of the size
constexpr int kLeastSide_px = 24;   // side of the smallest image
constexpr int kHalf = 8;            // half the side of a patch [px]
constexpr int kFarthest = 6;        // global motion [px of the smallest image]
constexpr int kMostSteps = 8;       // Gauss-Newton steps on a level
constexpr double kConverged = 0.1;  // length of its last step [px of the level]

Patch empty_patch() {
  Patch patch;
  patch.half = kHalf;
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

/// Fills the template around a pixel and returns the normal matrix over slopes, brightness and 1.
Matrix4d look_at(const cv::Mat& image, int u, int v, Patch& patch) {
  constexpr int kSide = 2 * kHalf;
  for (int row = 0; row < kSide; ++row) {
    const auto* here = image.ptr<std::uint16_t>(v - kHalf + row) + u - kHalf;
    const auto* above = image.ptr<std::uint16_t>(v - kHalf + row - 1) + u - kHalf;
    const auto* below = image.ptr<std::uint16_t>(v - kHalf + row + 1) + u - kHalf;
    const int k = row * kSide;
    for (int i = 0; i < kSide; ++i) {
      patch.brightness[k + i] = here[i];
      patch.slope_x[k + i] = 0.5F * static_cast<float>(here[i + 1] - here[i - 1]);
      patch.slope_y[k + i] = 0.5F * static_cast<float>(below[i] - above[i]);
    }
  }
  using Column = Eigen::Map<Eigen::Array<float, kSide * kSide, 1>>;
  Column T(patch.brightness.data());
  const Column gx(patch.slope_x.data());
  const Column gy(patch.slope_y.data());
  T -= T.mean();
  Matrix4d normal = Matrix4d::Zero();
  normal.row(0) << (gx * gx).sum(), (gx * gy).sum(), (gx * T).sum(), gx.sum();
  normal.row(1) << normal(0, 1), (gy * gy).sum(), (gy * T).sum(), gy.sum();
  normal.row(2) << normal(0, 2), normal(1, 2), (T * T).sum(), T.sum();
  normal.row(3) << normal(0, 3), normal(1, 3), normal(2, 3), kSide * kSide;
  return normal;
}

/// Returns the motion of the patch around `from_px` on a level, or `guess_px` if none fits better.
Vector2d moved(const cv::Mat& from,
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
  if (!((middle - least).minCoeff() >= 0)) return guess_px;
  const Matrix4d normal =
      look_at(from, static_cast<int>(middle.x()), static_cast<int>(middle.y()), patch);
  const Eigen::LDLT<Matrix4d> solver(normal);
  const double n = normal(3, 3);
  Vector2d moved_px = guess_px;
  Vector2d best_px = guess_px;
  double best = -1;
  for (int step = 0; step < kMostSteps; ++step) {
    const Warp warp{middle + moved_px};
    if (!is_inside(to.size(), patch, warp)) break;
    const PatchSums sums = shifted_sums(to, patch, warp.center);
    const Vector4d b(sums.products[0], sums.products[1], sums.products[6], sums.products[7]);
    const double variances = (sums.squares - b[3] * b[3] / n) * normal(2, 2);
    const double correlation = variances > 0 ? b[2] / std::sqrt(variances) : 0;
    if (correlation > best) {
      best = correlation;
      best_px = moved_px;
    }
    const Vector4d solution = solver.solve(b);
    if (!(solution[2] > 0)) break;
    const Vector2d step_px = -solution.head<2>() / solution[2];
    if (!(step_px.norm() < kHalf)) break;
    moved_px += step_px;
    if (step_px.norm() < kConverged) return moved_px;
  }
  return best_px;
}

/// Returns deviations from the mean in 64ths of the standard deviation, invariant to gain and
/// offset of the exposure, CV_16SC1. Sums of integers do not depend on their order.
cv::Mat standardized(const cv::Mat& image) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  const double scale = deviation[0] > 0 ? 64 / deviation[0] : 0;
  cv::Mat result;
  image.convertTo(result, CV_16S, scale, -scale * mean[0]);
  return result;
}

/// Returns the mean square difference of the images for a motion of whole pixels.
double difference(const cv::Mat& from, const cv::Mat& to, const cv::Point& by) {
  const cv::Rect common = cv::Rect({0, 0}, to.size()) & cv::Rect(by, from.size());
  return cv::norm(from(common - by), to(common), cv::NORM_L2SQR) / common.area();
}

/// Estimates the motion of the whole image, from which each place starts. Without it a jolt would
/// lose places near the border.
Vector2d global_motion(const cv::Mat& from, const cv::Mat& to) {
  const cv::Mat a = standardized(from);
  const cv::Mat b = standardized(to);
  const int farthest = std::min({kFarthest, from.cols / 3, from.rows / 3});
  cv::Point best(0, 0);
  double least = difference(a, b, best);
  for (int v = -farthest; v <= farthest; ++v) {
    for (int u = -farthest; u <= farthest; ++u) {
      const double now = difference(a, b, {u, v});
      if (now < least) {
        least = now;
        best = {u, v};
      }
    }
  }
  return {best.x, best.y};
}

}  // namespace

SmoothedPyramid smoothed_pyramid(const cv::Mat& gray) {
  SmoothedPyramid pyramid{smooth_image(gray)};
  for (int level = 1; level <= kCoarsest; ++level) {
    if (std::min(pyramid.back().cols, pyramid.back().rows) / 2 < kLeastSide_px) break;
    pyramid.push_back(halved(pyramid.back()));
  }
  return pyramid;
}

Eigen::Matrix2Xd coarse_flow(const SmoothedPyramid& from,
                             const SmoothedPyramid& to,
                             const Eigen::Matrix2Xd& raw_px) {
  Patch patch = empty_patch();
  const Vector2d start =
      global_motion(from.back(), to.back()) * std::ldexp(1.0, static_cast<int>(from.size()) - 1);
  Eigen::Matrix2Xd flow = start.replicate(1, raw_px.cols());
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) {
    for (auto level = static_cast<int>(from.size()) - 1; level >= 1; --level) {
      const double scale = std::ldexp(1.0, -level);
      // The center of a level's first pixel is the center of four pixels of the finer level.
      const Vector2d px = scale * (raw_px.col(j).array() + 0.5) - 0.5;
      flow.col(j) = moved(from[level], to[level], px, scale * flow.col(j), patch) / scale;
    }
  }
  return flow;
}

}  // namespace gpo
