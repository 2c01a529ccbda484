// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/homography_ransac.h"

#include "engine/geometry/homography.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

std::vector<bool> agreeing(const Matrix3d& H,
                           const Matrix2Xd& from,
                           const Matrix2Xd& to,
                           double threshold_px) {
  std::vector<bool> inlier(from.cols());
  for (Eigen::Index j = 0; j < from.cols(); ++j) {
    const Eigen::Vector3d y = H * from.col(j).homogeneous();
    inlier[j] = y.z() * H(2, 2) > 0 && (y.hnormalized() - to.col(j)).norm() <= threshold_px;
  }
  return inlier;
}

/// Whether more than `most` pairs agree with H, up to rounding; ends as soon as they cannot. For
/// the many samples that are to be refused, at a tenth of the time of fitting and `agreeing`.
bool more_agree(const Matrix3d& H,
                const Matrix2Xd& from,
                const Matrix2Xd& to,
                double threshold_px,
                std::ptrdiff_t most) {
  std::ptrdiff_t may_refuse = from.cols() - most;
  for (Eigen::Index j = 0; j < from.cols() && may_refuse > 0; ++j) {
    const Eigen::Vector3d y = H * from.col(j).homogeneous();
    const Eigen::Vector2d error = y.head<2>() - y.z() * to.col(j);
    const double radius = threshold_px * y.z();
    if (!(y.z() * H(2, 2) > 0 && error.squaredNorm() <= radius * radius)) --may_refuse;
  }
  return may_refuse > 0;
}

Matrix2Xd columns(const Matrix2Xd& x, const std::vector<bool>& chosen) {
  Matrix2Xd out(2, std::ranges::count(chosen, true));
  Eigen::Index k = 0;
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    if (chosen[j]) out.col(k++) = x.col(j);
  }
  return out;
}

std::array<int, 4> draw_four(std::mt19937_64& random, int n) {
  std::array<int, 4> sample{};
  for (int k = 0; k < 4;) {
    // Not std::uniform_int_distribution, whose numbers differ between standard libraries.
    sample[k] = static_cast<int>(random() % static_cast<std::uint64_t>(n));
    if (std::find(sample.begin(), sample.begin() + k, sample[k]) == sample.begin() + k) ++k;
  }
  return sample;
}

int iterations_needed(double inlier_ratio, const RansacOptions& options) {
  const double good_sample = std::pow(inlier_ratio, 4);
  if (good_sample >= 1) return 1;
  const double needed = std::log(1 - options.confidence) / std::log1p(-good_sample);
  return needed < options.most_iterations ? static_cast<int>(std::ceil(needed))
                                          : options.most_iterations;
}

}  // namespace

std::optional<RobustHomography> homography_ransac(const Matrix2Xd& from,
                                                  const Matrix2Xd& to,
                                                  const RansacOptions& options) {
  const int n = static_cast<int>(from.cols());
  if (n < 4) return std::nullopt;
  RobustHomography best{Matrix3d::Identity(), std::vector<bool>(n, !options.enabled)};
  if (!options.enabled) {
    const auto H = fit_homography(from, to);
    if (H) best.H = refine_homography(*H, from, to);
    return H ? std::optional(best) : std::nullopt;
  }
  std::mt19937_64 random(options.seed);
  std::ptrdiff_t most = 0;
  int needed = options.most_iterations;
  for (int iteration = 0; iteration < needed; ++iteration) {
    const std::array<int, 4> sample = draw_four(random, n);
    if (!more_agree(homography_through_four(from(Eigen::all, sample), to(Eigen::all, sample)),
                    from,
                    to,
                    options.threshold_px,
                    most))
      continue;
    const auto H = fit_homography(from(Eigen::all, sample), to(Eigen::all, sample));
    if (!H) continue;
    std::vector<bool> inlier = agreeing(*H, from, to, options.threshold_px);
    const auto count = std::ranges::count(inlier, true);
    if (count <= most) continue;
    most = count;
    best = {*H, std::move(inlier)};
    needed = iterations_needed(static_cast<double>(count) / n, options);
  }
  // The refined homography gains inliers that the sample's noise had cost, and the other way round.
  for (int round = 0; round < 3 && most >= 4; ++round) {
    best.H = refine_homography(best.H, columns(from, best.inlier), columns(to, best.inlier));
    std::vector<bool> inlier = agreeing(best.H, from, to, options.threshold_px);
    most = std::ranges::count(inlier, true);
    if (inlier == best.inlier) break;
    best.inlier = std::move(inlier);
  }
  return most >= 4 ? std::optional(best) : std::nullopt;
}

}  // namespace gpo
