// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/relative_pose.h"

#include "engine/geometry/pose.h"
#include "tests/engine/rotation_error.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::rotation_error_deg;

constexpr double kFocal_px = 500;

/// A cloud before two cameras, the second turned by `turn_rad` and moved by `baseline`; the last
/// `outliers` tracks are seen anywhere in the second picture.
struct CloudOptions {
  double noise_px = 0.3;
  double baseline = 0.3;
  int tracks = 200;
  int outliers = 0;
  Vector3d turn_rad = {0.05, -0.08, 0.1};
  std::uint64_t seed = 1;
};

struct Cloud {
  RayPairs rays;
  Pose camera;  // the second, in the first
};

Cloud cloud(const CloudOptions& options) {
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> u(-0.6, 0.6), v(-0.45, 0.45), depth(1, 4);
  std::normal_distribution<double> normal;
  Cloud made;
  made.camera.R_wc = so3_exp(options.turn_rad);
  // One by one: which of several arguments is drawn first is the compiler's choice.
  Vector3d way;
  for (const int axis : {2, 1, 0}) way[axis] = normal(random);
  made.camera.p_wc = options.baseline * way.normalized();
  made.rays.i.resize(3, options.tracks);
  made.rays.j.resize(3, options.tracks);
  made.rays.group.assign(options.tracks, 0);
  const auto noisy = [&](const Vector3d& ray) -> Vector3d {
    const double sigma = options.noise_px / kFocal_px;
    const double x = sigma * normal(random), y = sigma * normal(random);
    return ray / ray.z() + Vector3d(x, y, 0);
  };
  const auto any_ray = [&] {
    const double y = v(random), x = u(random);
    return Vector3d(x, y, 1);
  };
  for (int k = 0; k < options.tracks; ++k) {
    const Vector3d ray = any_ray();
    made.rays.i.col(k) = noisy(ray);
    made.rays.j.col(k) = noisy(to_camera(made.camera, depth(random) * ray));
    if (k >= options.tracks - options.outliers) made.rays.j.col(k) = any_ray();
  }
  return made;
}

constexpr RelativeSolver kBothSolvers[] = {RelativeSolver::five_point, RelativeSolver::eigensolver};

double error_deg(const Cloud& made, const std::optional<RelativePose>& pose) {
  return pose ? rotation_error_deg(pose->R_ij, made.camera.R_wc) : 180;
}

TEST(RelativePose, IsExactWithoutNoise) {
  for (const RelativeSolver solver : kBothSolvers) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Cloud made = cloud({.noise_px = 0, .seed = seed});
      const auto pose = relative_pose(made.rays, {.solver = solver});
      EXPECT_LT(error_deg(made, pose), 1e-3) << seed;
      EXPECT_EQ(pose->inliers, 200) << seed;
      EXPECT_GT(std::abs(pose->direction.dot(made.camera.p_wc.normalized())), 1 - 1e-6) << seed;
      const auto distances2 =
          squared_sampson_distances(skew(pose->direction) * pose->R_ij, made.rays);
      EXPECT_LT(distances2.maxCoeff(), 1e-10) << seed;
    }
  }
}

TEST(RelativePose, KeepsItsRotationWhereTheCameraHardlyMoves) {
  for (const RelativeSolver solver : kBothSolvers) {
    for (const double baseline : {0.0, 0.003, 0.01}) {
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Cloud made = cloud({.baseline = baseline, .seed = seed});
        const auto pose = relative_pose(made.rays, {.solver = solver, .seed = seed});
        // Then only the parallax of the nearest point, at 1, may be taken for a turn.
        EXPECT_LT(error_deg(made, pose), 0.3 + degrees(baseline)) << baseline << " seed " << seed;
      }
    }
  }
}

TEST(RelativePose, ToleratesAFifthOfOutliersAndNamesThem) {
  for (const RelativeSolver solver : kBothSolvers) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Cloud made = cloud({.outliers = 40, .seed = seed});
      const auto pose = relative_pose(made.rays, {.solver = solver, .seed = seed});
      EXPECT_LT(error_deg(made, pose), 0.15) << seed;
      const auto first_outlier = pose->inlier.end() - 40;
      EXPECT_GE(std::count(pose->inlier.begin(), first_outlier, true), 158) << seed;
      // An outlier is near its epipolar line by chance now and then.
      EXPECT_LE(std::count(first_outlier, pose->inlier.end(), true), 4) << seed;
    }
  }
}

/// Where the eigensolver's starts are few it ends in a wrong minimum now and then.
TEST(RelativePose, SeldomLosesItsWayAmongOutliers) {
  constexpr int kSeeds = 200;
  for (const RelativeSolver solver : kBothSolvers) {
    int near = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const Cloud made = cloud({.outliers = 40, .seed = seed});
      const auto pose = relative_pose(made.rays, {.solver = solver, .seed = seed});
      EXPECT_LT(error_deg(made, pose), 0.5) << seed;
      near += error_deg(made, pose) < 0.15 ? 1 : 0;
    }
    EXPECT_GE(near, 190);
  }
}

// OpenCV's five points, RANSAC and chirality: its rotation is within what the noise allows of ours,
// and ours, which is refined, is nearer to the truth.
TEST(RelativePose, AgreesWithOpenCv) {
  for (const RelativeSolver solver : kBothSolvers) {
    std::vector<double> ours_deg, theirs_deg;
    for (std::uint64_t seed = 1; seed <= 21; ++seed) {
      const Cloud made = cloud({.outliers = 20, .seed = seed});
      std::vector<cv::Point2d> i, j;
      for (Eigen::Index k = 0; k < made.rays.i.cols(); ++k) {
        i.emplace_back(made.rays.i(0, k), made.rays.i(1, k));
        j.emplace_back(made.rays.j(0, k), made.rays.j(1, k));
      }
      const cv::Mat K = cv::Mat::eye(3, 3, CV_64F);
      cv::Mat mask, R, t;
      const cv::Mat E = cv::findEssentialMat(i, j, K, cv::RANSAC, 0.9999, 1.0 / kFocal_px, mask);
      cv::recoverPose(E, i, j, K, R, t, mask);
      Matrix3d R_ji;
      cv::cv2eigen(R, R_ji);
      const auto pose = relative_pose(made.rays, {.solver = solver, .seed = seed});
      ASSERT_TRUE(pose);
      theirs_deg.push_back(rotation_error_deg(R_ji.transpose(), made.camera.R_wc));
      ours_deg.push_back(error_deg(made, pose));
      EXPECT_LT(rotation_error_deg(R_ji.transpose(), pose->R_ij), theirs_deg.back() + 0.1) << seed;
      EXPECT_LT(theirs_deg.back(), 1.0) << seed;
    }
    std::ranges::sort(ours_deg);
    std::ranges::sort(theirs_deg);
    EXPECT_LT(ours_deg[10], 0.05);
    EXPECT_LE(ours_deg[10], theirs_deg[10]);
  }
}

TEST(RelativePose, IsTheSameEachTime) {
  const Cloud made = cloud({.outliers = 40});
  for (const RelativeSolver solver : kBothSolvers) {
    const auto first = relative_pose(made.rays, {.solver = solver, .seed = 3});
    const auto second = relative_pose(made.rays, {.solver = solver, .seed = 3});
    EXPECT_EQ(first->R_ij, second->R_ij);
    EXPECT_EQ(first->inlier, second->inlier);
  }
}

TEST(RelativePose, HasNoneOfTooFewTracks) {
  for (const RelativeSolver solver : kBothSolvers) {
    EXPECT_FALSE(relative_pose(cloud({.tracks = 11}).rays, {.solver = solver}));
    EXPECT_TRUE(relative_pose(cloud({.tracks = 12}).rays, {.solver = solver}));
    EXPECT_FALSE(relative_pose({}, {.solver = solver}));
    // Nothing to agree on.
    EXPECT_FALSE(relative_pose(cloud({.tracks = 30, .outliers = 30}).rays,
                               {.solver = solver, .gate = 1e-5}));
  }
}

}  // namespace
}  // namespace gpo
