// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotations.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "tests/engine/rotation_error.h"
#include "tests/engine/simulated_window.h"

#include <cstdlib>
#include <random>

#include <gmock/gmock.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using test::Motion;
using test::rotation_error_deg;
using test::simulate;
using test::Simulation;

TEST(RotationAveraging, ToleratesAThirdOfGrossOutliers) {
  std::srand(5);
  std::mt19937_64 random(5);
  std::vector<Matrix3d> truth{Matrix3d::Identity()};
  for (int i = 1; i < 20; ++i) truth.push_back(so3_exp(0.5 * Eigen::Vector3d::Random()));
  std::vector<RelativeRotation> relative;
  for (int i = 0; i < 20; ++i) {
    for (int j = i + 1; j < 20; ++j) {
      const double size = random() % 3 == 0 && i > 0 ? 0.8 : 0.001;
      relative.push_back(
          {i, j, truth[i].transpose() * truth[j] * so3_exp(size * Eigen::Vector3d::Random())});
    }
  }
  std::vector<Matrix3d> start{Matrix3d::Identity()};
  for (int j = 1; j < 20; ++j) start.push_back(truth[j] * so3_exp(0.1 * Eigen::Vector3d::Random()));
  const auto R = average_rotations(relative, start);
  for (int i = 0; i < 20; ++i) EXPECT_LT(rotation_error_deg(R[i], truth[i]), 0.1);
}

TEST(HomographyRotations, AreExactWithoutNoise) {
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::wander}) {
    const Simulation s = simulate({.motion = motion, .noise_px = 0, .seed = 2});
    const Rotations rotations = averaged_rotations(s.window);
    ASSERT_EQ(rotations.reason, "");
    for (int i = 0; i < 30; ++i)
      EXPECT_LT(rotation_error_deg(rotations.R_wc[i], s.cameras[i].R_wc), 0.01) << "frame " << i;
  }
}

/// Returns OpenCV's five-point rotation between the reference frame and the last one.
Matrix3d five_point_rotation(const Simulation& s) {
  std::vector<cv::Point2d> from, to;
  for (int j = 0; j < s.window.track_count(); ++j) {
    from.emplace_back(s.window.points_px[0](0, j), s.window.points_px[0](1, j));
    to.emplace_back(s.window.points_px[29](0, j), s.window.points_px[29](1, j));
  }
  cv::Mat K, mask, R, t;
  cv::eigen2cv(s.window.K, K);
  const cv::Mat E = cv::findEssentialMat(from, to, K, cv::RANSAC, 0.999, 1.0, mask);
  cv::recoverPose(E, from, to, K, R, t, mask);
  Matrix3d R_21;
  cv::cv2eigen(R, R_21);
  return R_21.transpose();
}

// Justifies decomposed homographies instead of five-point rotations (engine/method.md,
// "Rotations").
TEST(HomographyRotations, AreMoreAccurateThanFivePointOnAPlane) {
  std::vector<double> averaged, five_point;
  for (std::uint64_t seed = 1; seed <= 21; ++seed) {
    const Simulation s = simulate({.motion = Motion::orbit, .seed = seed});
    const Rotations rotations = averaged_rotations(s.window);
    ASSERT_EQ(rotations.reason, "");
    averaged.push_back(rotation_error_deg(rotations.R_wc[29], s.cameras[29].R_wc));
    five_point.push_back(rotation_error_deg(five_point_rotation(s), s.cameras[29].R_wc));
  }
  RecordProperty("averaged_deg", std::to_string(median(averaged)));
  RecordProperty("five_point_deg", std::to_string(median(five_point)));
  EXPECT_LT(median(averaged), 0.5 * median(five_point));
  EXPECT_LT(median(averaged), 0.15);
}

// On a straight approach the twin normal hardly moves, and at low parallax noise hides its motion.
TEST(HomographyRotations, AreRightOrReportedAsAmbiguous) {
  int determined = 0;
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::approach, Motion::wander}) {
    for (const double travel : {0.04, 0.1, 0.3}) {
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Simulation s = simulate({.motion = motion, .travel = travel, .seed = seed});
        const Rotations rotations = averaged_rotations(s.window);
        if (rotations.R_wc.empty()) {
          EXPECT_THAT(rotations.reason, ::testing::HasSubstr("fit equally well"));
          continue;
        }
        ++determined;
        EXPECT_LT(rotation_error_deg(rotations.R_wc[29], s.cameras[29].R_wc), 2.0)
            << static_cast<int>(motion) << " travel " << travel << " seed " << seed;
      }
    }
  }
  RecordProperty("windows_determined_of_60", determined);
  EXPECT_GE(determined, 40);
}

}  // namespace
}  // namespace gpo
