// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/methods/plane/normal_landscape.h"
#include "ui/views/scene/scene_geometry.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(NormalsDisc, CircleIsAsFarFromItsNormalAsItSays) {
  const Vector3d normal = Vector3d(0.2, -0.5, -1).normalized();
  for (const Vector2d& disc : circle_on_disc(normal, 7))
    EXPECT_NEAR(angle_deg(normal_from_disc(disc), normal), 7, 1e-6);
}

TEST(NormalsDisc, EllipseHasTheAxesOfTheCovariance) {
  const Vector3d normal = Vector3d(0, -0.6, -0.8);
  const Vector3d a = Vector3d::UnitX(), b = normal.cross(a);
  const Eigen::Matrix3d covariance = 0.0004 * a * a.transpose() + 0.0001 * b * b.transpose();
  double least = 90, most = 0;
  for (const Vector2d& disc : confidence_on_disc(normal, covariance)) {
    const double angle = angle_deg(normal_from_disc(disc), normal);
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  EXPECT_NEAR(most, degrees(0.02 * std::sqrt(kChiSquare2)), 1e-3);
  EXPECT_NEAR(least, degrees(0.01 * std::sqrt(kChiSquare2)), 1e-3);
}

}  // namespace
}  // namespace gpo
