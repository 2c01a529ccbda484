// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/tracker.h"
#include "engine/geometry/homography.h"

#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr int kHalf = 10;
const Camera kCamera{640,
                     480,
                     498.2,
                     497.6,
                     322.4,
                     238.1,
                     Distortion::radial_tangential,
                     {0.092, -0.184, 6e-4, -9e-4}};

/// Returns the homography of a camera that moved by 15 degrees, or a part of them, around the
/// middle of the image; the plane is Z = `distance`.
Matrix3d homography(double distance, double part = 1) {
  const Matrix3d K = intrinsic_matrix(kCamera);
  const Matrix3d R(Eigen::AngleAxisd(0.26 * part, Eigen::Vector3d(0.2, 0.9, 0.3).normalized()));
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d center = z - R.transpose() * z;
  return K * R * (Matrix3d::Identity() - center * z.transpose() / distance) * K.inverse();
}

Vector2d carried(const Matrix3d& H, const Vector2d& raw_px) {
  return distort(kCamera, transfer(H, undistort(kCamera, raw_px)));
}

/// Returns the affine warp by finite differences.
Warp affine_warp(const Matrix3d& H, const Vector2d& middle) {
  const double h = 4;
  Warp warp{carried(H, middle)};
  warp.linear << (carried(H, middle + Vector2d(h, 0)) - carried(H, middle - Vector2d(h, 0))) /
                     (2 * h),
      (carried(H, middle + Vector2d(0, h)) - carried(H, middle - Vector2d(0, h))) / (2 * h);
  return warp;
}

double worst_px(const Warp& warp, const Matrix3d& H, const Vector2d& middle) {
  double worst = 0;
  for (int v = -kHalf; v <= kHalf; ++v)
    for (int u = -kHalf; u <= kHalf; ++u)
      worst = std::max(worst, (warp({u, v}) - carried(H, middle + Vector2d(u, v))).norm());
  return worst;
}

bool in_image(const Vector2d& raw_px) {
  return raw_px.minCoeff() > kHalf && raw_px.x() < kCamera.width - kHalf &&
         raw_px.y() < kCamera.height - kHalf;
}

Matrix2Xd grid() {
  Matrix2Xd places(2, 15 * 11);
  for (int k = 0; k < places.cols(); ++k) places.col(k) << 40 + 40 * (k % 15), 40 + 40 * (k / 15);
  return places;
}

TEST(LocalShape, MatchesHomographyAndLensOfAPlane) {
  const Matrix2Xd places = grid();
  const Matrix3d H = homography(1);
  Matrix2Xd now(2, places.cols());
  for (int j = 0; j < places.cols(); ++j)
    now.col(j) = undistort(kCamera, carried(H, places.col(j)));
  auto around = make_neighborhoods(kCamera, places, kHalf);
  int better = 0;
  for (int j = 0; j < places.cols(); ++j) {
    const Vector2d middle = places.col(j);
    const Warp affine = affine_warp(H, middle);
    if (!now.col(j).allFinite() || !in_image(affine.center)) continue;
    const Warp shape = shaped(kCamera, affine, now, kHalf, around[j]);
    EXPECT_EQ(shape.center, affine.center);
    EXPECT_LT(worst_px(shape, H, middle), 0.02) << middle.transpose();
    better += worst_px(affine, H, middle) > 0.03 ? 1 : 0;
  }
  EXPECT_GT(better, 60);
}

// Every third track is on a plane that is nearer by a third, and some tracks are lost.
TEST(LocalShape, IgnoresNeighborsOnAnotherSurface) {
  constexpr int kFrames = 10;
  const Matrix2Xd places = grid();
  auto around = make_neighborhoods(kCamera, places, kHalf);
  for (int frame = 1; frame <= kFrames; ++frame) {
    const double part = static_cast<double>(frame) / kFrames;
    const Matrix3d H[] = {homography(1, part), homography(0.7, part)};
    Matrix2Xd now(2, places.cols());
    for (int j = 0; j < places.cols(); ++j)
      now.col(j) = undistort(kCamera, carried(H[j % 3 == 0 ? 1 : 0], places.col(j)));
    for (int j = 0; j < places.cols(); j += 10)
      now.col(j).setConstant(std::numeric_limits<double>::quiet_NaN());
    for (int j = 0; j < places.cols(); ++j) {
      const Matrix3d& own = H[j % 3 == 0 ? 1 : 0];
      const Vector2d middle = places.col(j);
      const Warp affine = affine_warp(own, middle);
      if (!now.col(j).allFinite() || !in_image(affine.center)) continue;
      const Warp shape = shaped(kCamera, affine, now, kHalf, around[j]);
      EXPECT_LT(worst_px(shape, own, middle), 0.05 + 0.5 * worst_px(affine, own, middle))
          << frame << ": " << j;
    }
  }
}

TEST(LocalShape, IsTheTemplatesOwnWithoutNeighbors) {
  Matrix2Xd alone(2, 1);
  alone << 200, 150;
  const Warp warp = affine_warp(homography(1), alone.col(0));
  auto around = make_neighborhoods(kCamera, alone, kHalf);
  EXPECT_TRUE(around[0].neighbors.empty());
  const Warp shape = shaped(kCamera, warp, alone, kHalf, around[0]);
  for (const Vector2d& d : {Vector2d(-10, 10), Vector2d(10, 10), Vector2d(0, -10)})
    EXPECT_LT((shape(d) - warp(d)).norm(), 0.01);
}

}  // namespace
}  // namespace gpo
