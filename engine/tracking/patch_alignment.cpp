// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/patch.h"

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
    const Vector4d solution = patch_template.shift * Vector4d(b(kShiftColumns));
    step.gain = solution(2);
    step.t = solution.head<2>() / step.gain;
  } else {
    const Vector8d solution = patch_template.affine * b;
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

/// Returns zeros instead of infinite values for what a singular matrix does not determine.
template <class Matrix>
Matrix inverse_of(const Matrix& normal) {
  return normal.ldlt().solve(Matrix::Identity());
}

/// Returns the part of a template inside of the image, with the inverse for these unknowns only.
PatchTemplate part_inside(const cv::Mat& image,
                          const Patch& patch,
                          const Warp& warp,
                          MotionModel unknown) {
  PatchTemplate part;
  part.patch = inside_part(image.size(), patch, warp);
  part.normal = patch_normal_matrix(part.patch);
  if (unknown == MotionModel::shift)
    part.shift = inverse_of(Matrix4d(part.normal(kShiftColumns, kShiftColumns)));
  else
    part.affine = inverse_of(part.normal);
  return part;
}

/// Returns nullopt if less than half of the pixels are in the image, or if the gain is negative.
std::optional<Correction> step_from(const cv::Mat& image,
                                    const PatchTemplate& patch_template,
                                    const Warp& warp,
                                    MotionModel unknown) {
  Correction step;
  if (is_inside(image.size(), patch_template.patch, warp)) {
    step = solved(patch_sums(image, patch_template.patch, warp, unknown), patch_template, unknown);
  } else {
    const PatchTemplate part = part_inside(image, patch_template.patch, warp, unknown);
    if (2 * part.normal(kOne, kOne) < (2 * part.patch.half + 1) * (2 * part.patch.half + 1))
      return std::nullopt;
    step = solved(patch_sums(image, part.patch, warp, unknown), part, unknown);
  }
  if (!(step.gain > 0)) return std::nullopt;
  return step;
}

}  // namespace

PatchTemplate make_patch_template(Patch patch) {
  PatchTemplate patch_template;
  patch_template.patch = std::move(patch);
  patch_template.normal = patch_normal_matrix(patch_template.patch);
  patch_template.affine = inverse_of(patch_template.normal);
  patch_template.shift = inverse_of(Matrix4d(patch_template.normal(kShiftColumns, kShiftColumns)));
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
    const PatchSums sums = patch_sums(image, patch_template.patch, beside, MotionModel::shift);
    slopes += side * sums.products.cast<double>() / 2;
    if (side == 0) gain = solved(sums, patch_template, MotionModel::shift).gain;
  }
  const auto squares = patch_template.normal.topLeftCorner<2, 2>();
  return patch_template.along_edge.dot(slopes.head<2>()) /
         (gain * patch_template.along_edge.dot(squares * patch_template.along_edge));
}

}  // namespace gpo
