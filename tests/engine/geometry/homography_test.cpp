// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography.h"

#include "engine/frontend/inliers.h"
#include "tests/engine/simulated_window.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

using test::simulate;
using test::Simulation;

std::vector<cv::Point2d> to_points(const Eigen::Matrix2Xd& x) {
  std::vector<cv::Point2d> points;
  for (const auto& column : x.colwise()) points.emplace_back(column.x(), column.y());
  return points;
}

double largest_difference_px(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  double largest = 0;
  for (int u = 0; u < 640; u += 64) {
    for (int v = 0; v < 480; v += 48) {
      const Eigen::Vector2d px(u, v);
      largest = std::max(largest, (transfer(A, px) - transfer(B, px)).norm());
    }
  }
  return largest;
}

TEST(Homography, FitIsExactWithoutNoise) {
  const Simulation s = simulate({.motion = test::Motion::orbit, .noise_px = 0});
  const auto four =
      fit_homography(s.window.points_px[0].leftCols(4), s.window.points_px[29].leftCols(4));
  const auto all = fit_homography(s.window.points_px[0], s.window.points_px[29]);
  EXPECT_LT(largest_difference_px(*four, s.window.H_i1[29]), 1e-5);
  EXPECT_LT(largest_difference_px(*all, s.window.H_i1[29]), 1e-7);
}

TEST(Homography, RefinementMatchesOpenCv) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulation s = simulate({.motion = test::Motion::wander, .seed = seed});
    const auto& from = s.window.points_px[0];
    const auto& to = s.window.points_px[20];
    Eigen::Matrix3d theirs;
    cv::cv2eigen(cv::findHomography(to_points(from), to_points(to), 0), theirs);
    const Eigen::Matrix3d ours = refine_homography(*fit_homography(from, to), from, to);
    EXPECT_LT(largest_difference_px(ours, theirs), 0.01);
  }
}

TEST(Homography, RejectsCollinearPoints) {
  Eigen::Matrix2Xd line(2, 6);
  line << 0, 1, 2, 3, 4, 5, 0, 2, 4, 6, 8, 10;
  EXPECT_FALSE(fit_homography(line, line));
  EXPECT_FALSE(fit_homography(line.leftCols(4), line.leftCols(4)));
}

TEST(HomographyRansac, FindsExactlyTheInliers) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation s =
        simulate({.motion = test::Motion::sideways, .off_plane = 0.3, .seed = seed});
    const auto found =
        homography_ransac(s.window.points_px[0], s.window.points_px[29], {.seed = seed});
    ASSERT_TRUE(found);
    int wrong = 0;
    for (int j = 0; j < 150; ++j) wrong += found->inlier[j] != s.on_plane[j] ? 1 : 0;
    EXPECT_LE(wrong, 3);  // noise of 0.5 px against a threshold of 2 px
    EXPECT_LT(largest_difference_px(found->H, s.window.H_i1[29]), 2.0);
  }
}

TEST(HomographyRansac, MatchesInliersOfOpenCv) {
  const Simulation s = simulate({.off_plane = 0.3});
  const auto ours = homography_ransac(s.window.points_px[0], s.window.points_px[29], {});
  // OpenCV's mask is that of its best sample, not of the refined H.
  const cv::Mat H_cv = cv::findHomography(
      to_points(s.window.points_px[0]), to_points(s.window.points_px[29]), cv::RANSAC, 2.0);
  Eigen::Matrix3d theirs;
  cv::cv2eigen(H_cv, theirs);
  int different = 0;
  for (int j = 0; j < 150; ++j) {
    const Eigen::Vector2d error =
        transfer(theirs, s.window.points_px[0].col(j)) - s.window.points_px[29].col(j);
    different += ours->inlier[j] != (error.norm() <= 2.0) ? 1 : 0;
  }
  EXPECT_LE(different, 2);
}

TEST(HomographyRansac, RepeatsForSameSeedAndKeepsAllIfDisabled) {
  const Simulation s = simulate({.off_plane = 0.3});
  const auto a = homography_ransac(s.window.points_px[0], s.window.points_px[29], {.seed = 5});
  const auto b = homography_ransac(s.window.points_px[0], s.window.points_px[29], {.seed = 5});
  EXPECT_EQ(a->H, b->H);
  EXPECT_EQ(a->inlier, b->inlier);
  const auto off =
      homography_ransac(s.window.points_px[0], s.window.points_px[29], {.enabled = false});
  EXPECT_EQ(std::ranges::count(off->inlier, true), 150);
}

TEST(HomographyRansac, RejectsFewerThanFourPairs) {
  EXPECT_FALSE(
      homography_ransac(Eigen::Matrix2Xd::Random(2, 3), Eigen::Matrix2Xd::Random(2, 3), {}));
}

}  // namespace
}  // namespace gpo
