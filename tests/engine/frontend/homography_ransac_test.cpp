// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/inliers.h"
#include "engine/geometry/homography.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

struct Pairs {
  Matrix2Xd from, to;
};

/// Of 120 pairs the first ones are moved by a homography, with half a pixel of noise, the others
/// some pixels farther; in the corner of some pictures stand a few corners of a chessboard, where
/// samples are in a line.
Pairs simulated_pairs(int with_homography, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(0, 640);
  std::normal_distribution<double> noise(0, 1);
  Matrix3d H;
  H << 1.05, 0.03, 10, -0.02, 0.97, -5, 1e-4, -5e-5, 1;
  Pairs pairs{Matrix2Xd(2, 120), Matrix2Xd(2, 120)};
  for (int j = 0; j < 120; ++j) {
    pairs.from.col(j) << x(random), 0.75 * x(random);
    if (j < static_cast<int>(seed % 4) * 8) pairs.from.col(j) << 20.0 * (j % 8), 20.0 * (j % 3);
    const double sigma_px = j < with_homography ? 0.5 : 10;
    pairs.to.col(j) =
        transfer(H, pairs.from.col(j)) + sigma_px * Eigen::Vector2d(noise(random), noise(random));
  }
  return pairs;
}

std::vector<bool> agreeing(const Matrix3d& H, const Pairs& pairs, double threshold_px) {
  std::vector<bool> inlier;
  for (Eigen::Index j = 0; j < pairs.from.cols(); ++j) {
    const bool in_front = (H * pairs.from.col(j).homogeneous()).z() * H(2, 2) > 0;
    inlier.push_back(in_front &&
                     (transfer(H, pairs.from.col(j)) - pairs.to.col(j)).norm() <= threshold_px);
  }
  return inlier;
}

/// The best sample's inliers, every sample fitted and judged in full.
std::vector<bool> plain_ransac(const Pairs& pairs, const RansacOptions& options) {
  std::mt19937_64 random(options.seed);
  std::vector<bool> best;
  std::ptrdiff_t most = 0;
  double needed = options.most_iterations;
  const auto n = static_cast<std::uint64_t>(pairs.from.cols());
  for (int iteration = 0; iteration < needed; ++iteration) {
    std::array<int, 4> four{};
    for (int k = 0; k < 4;) {
      four[k] = static_cast<int>(random() % n);
      if (std::find(four.begin(), four.begin() + k, four[k]) == four.begin() + k) ++k;
    }
    const auto H = fit_homography(pairs.from(Eigen::all, four), pairs.to(Eigen::all, four));
    if (!H) continue;
    const std::vector<bool> inlier = agreeing(*H, pairs, options.threshold_px);
    const auto count = std::ranges::count(inlier, true);
    if (count <= most) continue;
    most = count;
    best = inlier;
    const double ratio = static_cast<double>(count) / static_cast<double>(n);
    const double wanted = std::log(1 - options.confidence) / std::log1p(-std::pow(ratio, 4));
    needed = std::min<double>(options.most_iterations, std::ceil(wanted));
  }
  return best;
}

Matrix2Xd columns(const Matrix2Xd& x, const std::vector<bool>& chosen) {
  std::vector<int> kept;
  for (int j = 0; j < x.cols(); ++j) {
    if (chosen[j]) kept.push_back(j);
  }
  return x(Eigen::all, kept);
}

TEST(HomographyRansac, ChoosesWhatPlainRansacChooses) {
  for (const int with_homography : {114, 60, 36, 24}) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
      const Pairs pairs = simulated_pairs(with_homography, seed);
      const RansacOptions options;
      const auto robust = homography_ransac(pairs.from, pairs.to, options);
      ASSERT_TRUE(robust) << with_homography << " " << seed;
      std::vector<bool> inlier = plain_ransac(pairs, options);
      const auto H = fit_homography(columns(pairs.from, inlier), columns(pairs.to, inlier));
      ASSERT_TRUE(H);
      Matrix3d refined = *H;
      for (int round = 0; round < 3; ++round) {
        refined =
            refine_homography(refined, columns(pairs.from, inlier), columns(pairs.to, inlier));
        inlier = agreeing(refined, pairs, options.threshold_px);
      }
      EXPECT_EQ(robust->inlier, inlier) << with_homography << " " << seed;
      EXPECT_LT((robust->H - refined).norm(), 1e-6) << with_homography << " " << seed;
    }
  }
}

TEST(HomographyRansac, TellsInliersFromOutliers) {
  const int with_homography = 60;
  const Pairs pairs = simulated_pairs(with_homography, 4);
  const auto robust = homography_ransac(pairs.from, pairs.to, {});
  ASSERT_TRUE(robust);
  EXPECT_GE(std::count(robust->inlier.begin(), robust->inlier.begin() + with_homography, true), 57);
  EXPECT_LE(std::count(robust->inlier.begin() + with_homography, robust->inlier.end(), true), 6);
}

}  // namespace
}  // namespace gpo
