// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/look/orbit_camera.h"
#include "ui/views/scene/scene_geometry.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d some_covariance() {
  Matrix3d L;
  L << 0.02, 0, 0, 0.01, 0.005, 0, -0.004, 0.002, 0.01;
  return L * L.transpose();
}

TEST(UncertaintyGeometry, EllipsoidHoldsNinetyFivePercentOfCenters) {
  const Matrix3d covariance = some_covariance();
  const Matrix3d L = covariance.llt().matrixL();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int inside = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Vector3d x = L * Vector3d(normal(random), normal(random), normal(random));
    inside += x.dot(covariance.inverse() * x) <= kChiSquare3 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / kDraws, 0.95, 0.005);
}

TEST(UncertaintyGeometry, LinesLieOnTheEllipsoidAndGrowAboutTheCenter) {
  const Vector3d center(1, -2, 0.5);
  const Matrix3d information = some_covariance().inverse();
  for (const double enlarged : {1.0, 10.0}) {
    for (const auto& line : confidence_ellipsoid(center, some_covariance(), enlarged)) {
      for (const Vector3d& point : line) {
        const Vector3d from = (point - center) / enlarged;
        EXPECT_NEAR(from.dot(information * from), kChiSquare3, 1e-6);
      }
    }
  }
}

TEST(UncertaintyGeometry, CertainCentersArePoints) {
  for (const auto& line : confidence_ellipsoid(Vector3d::Ones(), Matrix3d::Zero(), 100)) {
    for (const Vector3d& point : line) EXPECT_EQ(point, Vector3d::Ones());
  }
}

TEST(UncertaintyGeometry, RimTiltsTheArrowByTheAnglesOfNinetyFivePercent) {
  const NormalArrow arrow{Vector3d(1, 2, 3), Vector3d(1, 2, 5)};
  const Matrix3d covariance = Vector3d(1e-4, 4e-4, 0).asDiagonal();
  double least = 10, most = 0;
  for (const Vector3d& end : confidence_rim(arrow, covariance, 1)) {
    EXPECT_NEAR((end - arrow.base).norm(), 2, 1e-9);
    const double angle = std::acos((end - arrow.base).normalized().z());
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  EXPECT_NEAR(least, 0.01 * std::sqrt(kChiSquare2), 1e-6);
  EXPECT_NEAR(most, 0.02 * std::sqrt(kChiSquare2), 1e-6);
}

TEST(UncertaintyGeometry, RimGoesNoFartherThanARightAngle) {
  const NormalArrow arrow{Vector3d::Zero(), Vector3d::UnitZ()};
  const Matrix3d covariance = Vector3d(1e-2, 1e-2, 0).asDiagonal();
  for (const Vector3d& end : confidence_rim(arrow, covariance, 100)) EXPECT_NEAR(end.z(), 0, 1e-12);
}

TEST(UncertaintyGeometry, ArrowStandsOnThePlaneInView) {
  const Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.3});
  const NormalArrow arrow = normal_arrow(inspection, plane_grid(inspection, 0.2));
  const Plane& plane = inspection.initialization->plane;
  EXPECT_NEAR(plane.normal.dot(arrow.base) + plane.distance, 0, 1e-9);
  EXPECT_GT(plane.normal.dot(arrow.tip - arrow.base), 0);
  const OrbitCamera camera = default_scene_camera(inspection, 0.2, 4.0 / 3);
  const auto pixel = view_pixel(camera, arrow.tip, {960, 720});
  ASSERT_TRUE(pixel);
  EXPECT_TRUE(pixel->minCoeff() > 0 && pixel->x() < 960 && pixel->y() < 720);
}

}  // namespace
}  // namespace gpo
