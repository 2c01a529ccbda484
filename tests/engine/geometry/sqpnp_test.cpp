// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera_resection.h"
#include "tests/engine/rotation_error.h"

#include <limits>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using test::rotation_error_deg;

struct SeenPoints {
  Pose pose;
  Matrix3Xd points_w;
  Matrix2Xd seen;
};

/// Points about the world's origin, `thickness` deep, from 2 to 5 away, at any angle.
SeenPoints seen_points(std::uint64_t seed, int count, double thickness, double noise) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> normal;
  SeenPoints s;
  const auto any = [&]() { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  s.pose.R_wc = so3_exp(3 * any());
  const Vector3d origin_c(
      0.3 * uniform(random), 0.3 * uniform(random), 3.5 + 1.5 * uniform(random));
  s.pose.p_wc = -s.pose.R_wc * origin_c;
  s.points_w.resize(3, count);
  s.seen.resize(2, count);
  for (int k = 0; k < count; ++k) {
    s.points_w.col(k) = Vector3d(1, 1, thickness).asDiagonal() * any();
    s.seen.col(k) = to_camera(s.pose, s.points_w.col(k)).hnormalized();
    s.seen.col(k) += noise * Eigen::Vector2d(normal(random), normal(random));
  }
  return s;
}

Pose pose_by_opencv(const SeenPoints& s) {
  std::vector<cv::Point3d> objects;
  for (const auto& p : s.points_w.colwise()) objects.emplace_back(p.x(), p.y(), p.z());
  std::vector<cv::Point2d> images;
  for (const auto& p : s.seen.colwise()) images.emplace_back(p.x(), p.y());
  cv::Mat rotation, translation;
  EXPECT_TRUE(cv::solvePnP(objects,
                           images,
                           cv::Mat::eye(3, 3, CV_64F),
                           {},
                           rotation,
                           translation,
                           false,
                           cv::SOLVEPNP_SQPNP));
  Vector3d r, t;
  cv::cv2eigen(rotation, r);
  cv::cv2eigen(translation, t);
  const Eigen::Matrix3d R_cw = so3_exp(r);
  return {R_cw.transpose(), -R_cw.transpose() * t};
}

TEST(Sqpnp, IsExactWithoutNoiseOnAPlaneAndOffItFromAnyAngle) {
  for (const double thickness : {0.0, 1e-3, 0.1, 1.0}) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      for (const int count : {6, 40}) {
        const SeenPoints s = seen_points(seed, count, thickness, 0);
        const auto found = solve_sqpnp(s.points_w, s.seen);
        ASSERT_TRUE(found) << seed;
        EXPECT_LT((found->p_wc - s.pose.p_wc).norm(), 1e-6) << seed << " " << thickness;
        EXPECT_LT(rotation_error_deg(*found, s.pose), 1e-5) << seed << " " << thickness;
      }
    }
  }
}

// OpenCV ends its iterations at 1e-10 of a squared step.
TEST(Sqpnp, IsOpenCvsPoseOnAPlaneAndOffItWithNoise) {
  for (const double thickness : {0.0, 0.1, 1.0}) {
    for (const double noise : {1e-4, 1e-3, 4e-3}) {
      for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const SeenPoints s = seen_points(seed, 30, thickness, noise);
        const auto found = solve_sqpnp(s.points_w, s.seen);
        ASSERT_TRUE(found) << seed;
        const Pose expected = pose_by_opencv(s);
        EXPECT_LT((found->p_wc - expected.p_wc).norm(), 1e-4)
            << seed << " " << thickness << " " << noise;
        EXPECT_LT(rotation_error_deg(*found, expected), 1e-3)
            << seed << " " << thickness << " " << noise;
      }
    }
  }
}

// The mirrored pose, from which the points are behind, explains the pictures as well.
TEST(Sqpnp, PutsThePointsInFront) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const SeenPoints s = seen_points(seed, 20, seed % 2 == 0 ? 0.0 : 0.5, 1e-3);
    const auto found = solve_sqpnp(s.points_w, s.seen);
    ASSERT_TRUE(found) << seed;
    for (const auto& point : s.points_w.colwise()) EXPECT_GT(to_camera(*found, point).z(), 0);
  }
}

TEST(Sqpnp, HasNothingToSayOfWhatIsNotFinite) {
  SeenPoints s = seen_points(1, 10, 0.5, 0);
  s.seen(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve_sqpnp(s.points_w, s.seen));
}

}  // namespace
}  // namespace gpo
