// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/planes/inliers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

constexpr int kLeastNoisyTracks = 8;
constexpr int kMostNoisyTracks = 300;
/// A low quantile, because gross errors spoil the differences of eight observations.
constexpr double kQuantile = 0.25;
constexpr double kThirdDifference = 20;   // 1 + 9 + 9 + 1: variance for a variance of 1
constexpr double kThresholdSigmas = 4.2;  // three of a difference between two noisy observations
constexpr double kMostThreshold = 8;      // [pixel_unit]

std::vector<int> nearest_tracks(const Matrix2Xd& points_px, const std::vector<int>& tracks) {
  std::vector<int> neighbors;
  for (const int j : tracks) {
    const auto distance = [&](int k) {
      return k == j ? std::numeric_limits<double>::infinity()
                    : (points_px.col(k) - points_px.col(j)).squaredNorm();
    };
    neighbors.push_back(*std::ranges::min_element(tracks, {}, distance));
  }
  return neighbors;
}

}  // namespace

double track_noise_px(const std::vector<Matrix2Xd>& points_px) {
  const auto frames = std::ssize(points_px);
  if (frames < 4) return 0;
  std::vector<int> tracks;
  const int step = 1 + static_cast<int>(points_px[0].cols()) / kMostNoisyTracks;
  for (int j = 0; j < points_px[0].cols(); j += step)
    if (points_px[0].col(j).allFinite()) tracks.push_back(j);
  if (std::ssize(tracks) < kLeastNoisyTracks) return 0;
  const std::vector<int> neighbors = nearest_tracks(points_px[0], tracks);
  std::vector<double> lengths;
  for (std::ptrdiff_t i = 3; i < frames; ++i) {
    for (std::size_t k = 0; k < tracks.size(); ++k) {
      const auto at = [&](std::ptrdiff_t frame) -> Vector2d {
        return points_px[frame].col(tracks[k]) - points_px[frame].col(neighbors[k]);
      };
      const double length = (at(i) - 3 * at(i - 1) + 3 * at(i - 2) - at(i - 3)).norm();
      if (std::isfinite(length)) lengths.push_back(length);
    }
  }
  if (std::ssize(lengths) < kLeastNoisyTracks) return 0;
  const auto quantile = lengths.begin() + static_cast<std::ptrdiff_t>(
                                              kQuantile * static_cast<double>(lengths.size()));
  std::ranges::nth_element(lengths, quantile);
  return *quantile / std::sqrt(-2 * std::log(1 - kQuantile) * kThirdDifference * 2);
}

double usual_threshold_px(const Camera& camera, const std::vector<Matrix2Xd>& points_px) {
  const double unit = pixel_unit(camera);
  return std::clamp(
      kThresholdSigmas * track_noise_px(points_px), kUsualThreshold * unit, kMostThreshold * unit);
}

}  // namespace gpo
