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

namespace gpo::test {
namespace {

using Eigen::Matrix3Xd, Eigen::Vector3d;

struct Scene {
  Eigen::Matrix3d K = (Eigen::Matrix3d() << 480, 0, 310, 0, 500, 250, 0, 0, 1).finished();
  Pose pose;
  Matrix3Xd points;
  Eigen::Matrix2Xd pixels;
};

/// Simulates 40 points near the plane z = 2.
Scene random_scene(std::uint64_t seed, double thickness, double noise_px) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> noise;
  Scene s;
  s.pose.R_wc = so3_exp(0.3 * Vector3d(uniform(random), uniform(random), uniform(random)));
  s.pose.p_wc = 0.3 * Vector3d(uniform(random), uniform(random), uniform(random));
  s.points.resize(3, 40);
  s.pixels.resize(2, 40);
  for (int k = 0; k < 40; ++k) {
    s.points.col(k) << uniform(random), uniform(random), 2 + thickness * uniform(random);
    s.pixels.col(k) = (s.K * to_camera(s.pose, s.points.col(k))).hnormalized();
    s.pixels.col(k) += noise_px * Eigen::Vector2d(noise(random), noise(random));
  }
  return s;
}

TEST(CameraResection, IsExactWithoutNoiseIgnoresOutliersAndRejectsPointsBehindCamera) {
  for (const double thickness : {0.0, 0.01, 0.5})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Scene s = random_scene(seed, thickness, 0);
      const auto found = resect_camera(s.points, s.pixels, s.K);
      ASSERT_TRUE(found);
      EXPECT_LT((found->pose.p_wc - s.pose.p_wc).norm(), 1e-8);
      EXPECT_LT(rotation_error_deg(found->pose, s.pose), 1e-6);
      EXPECT_LT(found->median_px, 1e-6);
    }
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene s = random_scene(seed, 0.02, 0.3);
    for (int k = 0; k < 5; ++k) s.pixels.col(8 * k) += Eigen::Vector2d(30, -20 - k);
    const auto found = resect_camera(s.points, s.pixels, s.K);
    ASSERT_TRUE(found);
    EXPECT_LT((found->pose.p_wc - s.pose.p_wc).norm(), 0.01);
    EXPECT_LT(rotation_error_deg(found->pose, s.pose), 0.3);
  }
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene s = random_scene(seed, 0.02, 0);
    Pose neighbor = s.pose;
    neighbor.R_wc = neighbor.R_wc * so3_exp({0.02, -0.03, 0.01});
    neighbor.p_wc += Vector3d(0.05, 0, -0.03);
    const auto found = refine_pose(neighbor, s.points, s.pixels, s.K);
    ASSERT_TRUE(found);
    EXPECT_LT((found->pose.p_wc - s.pose.p_wc).norm(), 1e-8);
  }
  const Scene s = random_scene(1, 0, 0);
  EXPECT_FALSE(resect_camera(s.points.leftCols(3), s.pixels.leftCols(3), s.K));
  const Pose turned{so3_exp({0, 3.1, 0}), Vector3d::Zero()};
  EXPECT_FALSE(refine_pose(turned, s.points, s.pixels, s.K));
}

struct SeenPoints {
  Pose pose;
  Matrix3Xd points_w;
  Eigen::Matrix2Xd seen;
};

/// Simulates points around the world's origin at distances from 2 to 5 and any angle.
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

TEST(Sqpnp, IsExactWithoutNoise) {
  for (const double thickness : {0.0, 1e-3, 0.1, 1.0})
    for (std::uint64_t seed = 1; seed <= 100; ++seed)
      for (const int count : {6, 40}) {
        const SeenPoints s = seen_points(seed, count, thickness, 0);
        const auto found = solve_sqpnp(s.points_w, s.seen);
        ASSERT_TRUE(found) << seed;
        EXPECT_LT((found->p_wc - s.pose.p_wc).norm(), 1e-6) << seed << " " << thickness;
        EXPECT_LT(rotation_error_deg(*found, s.pose), 1e-5) << seed << " " << thickness;
      }
}

// OpenCV stops at a squared step of 1e-10. The mirrored pose with the points behind the camera fits
// equally well.
TEST(Sqpnp, MatchesOpenCvPutsPointsInFrontAndRejectsNonFinitePixels) {
  for (const double thickness : {0.0, 0.1, 1.0})
    for (const double noise : {1e-4, 1e-3, 4e-3})
      for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const SeenPoints s = seen_points(seed, 30, thickness, noise);
        const auto found = solve_sqpnp(s.points_w, s.seen);
        ASSERT_TRUE(found) << seed;
        const Pose expected = pose_by_opencv(s);
        EXPECT_LT((found->p_wc - expected.p_wc).norm(), 1e-4)
            << seed << " " << thickness << " " << noise;
        EXPECT_LT(rotation_error_deg(*found, expected), 1e-3)
            << seed << " " << thickness << " " << noise;
        for (const auto& point : s.points_w.colwise()) EXPECT_GT(to_camera(*found, point).z(), 0);
      }
  SeenPoints s = seen_points(1, 10, 0.5, 0);
  s.seen(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve_sqpnp(s.points_w, s.seen));
}

const std::vector<Pose> kCameras{
    {}, {so3_exp({0, 0.1, 0}), {0.3, 0, 0}}, {so3_exp({0.1, 0, 0.2}), {0, 0.2, 0.1}}};

Matrix3Xd rays_to(const Vector3d& point) {
  Matrix3Xd rays(3, kCameras.size());
  for (std::size_t i = 0; i < kCameras.size(); ++i) {
    const Vector3d y = to_camera(kCameras[i], point);
    rays.col(static_cast<int>(i)) = y / y.z();
  }
  return rays;
}

TEST(Triangulation, IsExactWithoutNoiseMinimizesTheErrorAndRejectsParallelRays) {
  for (const Vector3d& point :
       {Vector3d(0, 0, 1), Vector3d(-1, 0.5, 3), Vector3d(0.2, -0.4, 0.9)}) {
    const auto found = triangulate(kCameras, rays_to(point));
    ASSERT_TRUE(found);
    EXPECT_LT((*found - point).norm(), 1e-10);
  }
  Matrix3Xd rays = rays_to({0.1, 0.2, 1.5});
  rays.topRows<2>() += 0.002 * Eigen::Matrix2Xd::Ones(2, 3).cwiseProduct(
                                   (Eigen::Matrix2Xd(2, 3) << 1, -1, 1, -1, -1, 1).finished());
  const Vector3d found = triangulate(kCameras, rays).value();
  const auto cost = [&](const Vector3d& point) {
    double sum = 0;
    for (std::size_t i = 0; i < kCameras.size(); ++i) {
      const Vector3d y = to_camera(kCameras[i], point);
      sum += (y / y.z() - rays.col(static_cast<int>(i))).squaredNorm();
    }
    return sum;
  };
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(cost(found + 1e-3 * Vector3d::Unit(k)), cost(found));
    EXPECT_GT(cost(found - 1e-3 * Vector3d::Unit(k)), cost(found));
  }
  const std::vector<Pose> same{{}, {}};
  EXPECT_FALSE(triangulate(same, Matrix3Xd::Ones(3, 2)));
  Matrix3Xd diverging(3, 2);
  diverging << -0.2, 0.2, 0, 0, 1, 1;
  const std::vector<Pose> apart{{}, {Eigen::Matrix3d::Identity(), {0.3, 0, 0}}};
  EXPECT_FALSE(triangulate(apart, diverging));
  const std::vector<Pose> farther{{}, {Eigen::Matrix3d::Identity(), {1, 0, 0}}};
  EXPECT_NEAR(parallax_deg(farther, {0, 0, 1}), 45, 1e-12);
}

}  // namespace
}  // namespace gpo::test
