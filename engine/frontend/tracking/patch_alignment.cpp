// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector4d;
using Vector8d = Eigen::Matrix<double, 8, 1>;

constexpr int kMostCorrections = 20;  // Gauss-Newton steps
/// Last step of a template's pixels, by `Unknown`; a shift refines an affine result.
constexpr double kConverged_px[] = {0.01, 0.1};
constexpr double kNear_px = 0.2;  // last shift before all unknowns are solved for

constexpr std::array kShiftColumns{0, 1, 6, 7};
constexpr int kBrightness = 6;
constexpr int kOne = 7;

/// Least-squares solution of (15a) over t, B, gain and offset; linear in gain times t and B.
struct Correction {
  Vector2d t = Vector2d::Zero();
  Matrix2d B = Matrix2d::Zero();
  double gain = 0;
  double correlation = 0;
};

Correction solved(const PatchSums& sums, const PatchTemplate& patch_template, MotionModel unknown) {
  const Vector8d b = sums.products.cast<double>();
  Correction step;
  if (unknown == MotionModel::shift) {
    const Vector4d solution = patch_template.shift.solve(Vector4d(b(kShiftColumns)));
    step.gain = solution(2);
    step.t = solution.head<2>() / step.gain;
  } else {
    const Vector8d solution = patch_template.affine.solve(b);
    step.gain = solution(kBrightness);
    step.t = solution.head<2>() / step.gain;
    step.B << solution(2), solution(3), solution(4), solution(5);
    step.B /= step.gain;
  }
  const PatchNormalMatrix& A = patch_template.normal;
  const double n = A(kOne, kOne);
  const double covariance = b(kBrightness) - A(kBrightness, kOne) * b(kOne) / n;
  const double variances =
      (sums.squares - b(kOne) * b(kOne) / n) *
      (A(kBrightness, kBrightness) - A(kBrightness, kOne) * A(kBrightness, kOne) / n);
  step.correlation = variances > 0 ? covariance / std::sqrt(variances) : 0;
  return step;
}

bool contains(const cv::Size& image, const Vector2d& px) {
  return px.x() > 1 && px.y() > 1 && px.x() < image.width - 2 && px.y() < image.height - 2;
}

/// A template that shrinks or grows by more from an image to the next has slid to another place.
bool keeps_its_size(const Matrix2d& before, const Matrix2d& now) {
  const double share = now.determinant() / before.determinant();
  return share > 0.5 && share < 2;
}

/// Returns nullopt if less than half of the pixels are in the image, or if the gain is negative.
std::optional<Correction> step_from(const cv::Mat& image,
                                    const PatchTemplate& patch_template,
                                    const Warp& warp,
                                    MotionModel unknown) {
  Correction step;
  if (is_inside(image.size(), patch_template.patch, warp)) {
    step = solved(patch_sums(image, patch_template.patch, warp), patch_template, unknown);
  } else {
    const PatchTemplate part =
        make_patch_template(inside_part(image.size(), patch_template.patch, warp));
    if (2 * part.normal(kOne, kOne) < (2 * part.patch.half + 1) * (2 * part.patch.half + 1))
      return std::nullopt;
    step = solved(patch_sums(image, part.patch, warp), part, unknown);
  }
  if (!(step.gain > 0)) return std::nullopt;
  return step;
}

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

double difference(const cv::Mat& from, const cv::Mat& to, const cv::Point& by) {
  const cv::Rect common = cv::Rect({0, 0}, to.size()) & cv::Rect(by, from.size());
  return cv::norm(from(common - by), to(common), cv::NORM_L2SQR) / common.area();
}

/// Estimates the motion of the whole image. Without it a jolt would lose places near the border.
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

PatchTemplate make_patch_template(Patch patch) {
  PatchTemplate patch_template;
  patch_template.patch = std::move(patch);
  patch_template.normal = patch_normal_matrix(patch_template.patch);
  patch_template.affine.compute(patch_template.normal);
  patch_template.shift.compute(Matrix4d(patch_template.normal(kShiftColumns, kShiftColumns)));
  Eigen::SelfAdjointEigenSolver<Matrix2d> slopes;
  slopes.computeDirect(patch_template.normal.topLeftCorner<2, 2>());
  patch_template.along_edge = slopes.eigenvectors().col(0);
  patch_template.edge = slopes.eigenvalues()[0] / slopes.eigenvalues()[1];
  return patch_template;
}

Found search(const cv::Mat& image,
             const PatchTemplate& patch_template,
             const Warp& start,
             MotionModel unknown,
             const SearchOptions& options) {
  const double converged_px = kConverged_px[static_cast<std::size_t>(unknown)];
  Warp warp = start;
  MotionModel now = MotionModel::shift;  // until it is near enough for all unknowns
  for (int k = 0; k < kMostCorrections; ++k) {
    if (!contains(image.size(), warp.center))
      return {.end = TrackEnd{.reason = LossReason::left_image}};
    const auto step = step_from(image, patch_template, warp, now);
    if (!step) break;
    // (15a): w o (d + t + B d)^-1, so that the template's slopes remain valid.
    warp.linear *= (Matrix2d::Identity() + step->B).inverse();
    const Vector2d moved_px = -warp.linear * step->t;
    warp.center += moved_px;
    if (!keeps_its_size(start.linear, warp.linear)) break;
    const double far_px = (warp.center - start.center).norm();
    if (!(far_px <= options.farthest_px))
      return {.end = TrackEnd{.reason = LossReason::far_from_prediction,
                              .value = far_px,
                              .limit = options.farthest_px}};
    if (now != unknown) {
      if (moved_px.norm() < kNear_px) now = unknown;
      continue;
    }
    if (moved_px.norm() + patch_template.patch.half * step->B.norm() > converged_px) continue;
    if (step->correlation >= options.least_correlation) return {warp};
    return {.end = TrackEnd{.reason = LossReason::low_correlation,
                            .value = step->correlation,
                            .limit = options.least_correlation}};
  }
  return {.end = TrackEnd{.reason = LossReason::template_not_found}};
}

std::optional<double> detail_along_edge(const cv::Mat& image,
                                        const PatchTemplate& patch_template,
                                        const Warp& warp) {
  Vector8d slopes = Vector8d::Zero();
  double gain = 0;
  for (const int side : {-1, 0, 1}) {
    Warp beside = warp;
    beside.center += side * warp.linear * patch_template.along_edge;
    if (!is_inside(image.size(), patch_template.patch, beside)) return std::nullopt;
    const PatchSums sums = patch_sums(image, patch_template.patch, beside);
    slopes += side * sums.products.cast<double>() / 2;
    if (side == 0) gain = solved(sums, patch_template, MotionModel::shift).gain;
  }
  const auto squares = patch_template.normal.topLeftCorner<2, 2>();
  return patch_template.along_edge.dot(slopes.head<2>()) /
         (gain * patch_template.along_edge.dot(squares * patch_template.along_edge));
}

SmoothedPyramid smoothed_pyramid(const cv::Mat& gray) {
  SmoothedPyramid pyramid{smooth_image(gray)};
  while (std::min(pyramid.back().cols, pyramid.back().rows) / 2 >= kLeastSide_px)
    pyramid.push_back(halved(pyramid.back()));
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
