// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

struct RansacOptions {
  bool enabled = true;         ///< off: every pair is an inlier (the paper's ablation)
  double threshold_px = 2.0;   ///< largest transfer error of an inlier, in the second picture [px]
  std::uint64_t seed = 1;      ///< of the random samples
  double confidence = 0.9999;  ///< of having drawn one sample without an outlier [-]
  int most_iterations = 2000;  ///< [-]

  bool operator==(const RansacOptions&) const = default;
};

struct RobustHomography {
  Eigen::Matrix3d H;         ///< to ~ H from, refined on its inliers
  std::vector<bool> inlier;  ///< one a pair
};

/// 4-point RANSAC (Fischler & Bolles) with the sample's orientation checked, refined on the
/// inliers. Both 2 x n. Nothing where fewer than 4 pairs agree.
std::optional<RobustHomography> homography_ransac(const Eigen::Matrix2Xd& from,
                                                  const Eigen::Matrix2Xd& to,
                                                  const RansacOptions& options);

}  // namespace gpo
