// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/residuals/ceres_solver.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDelta = 1e-6;

TEST(Direction, JacobianAgreesWithDifferences) {
  std::srand(7);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Quaterniond q = Quaterniond::UnitRandom();
    for (int k = 0; k < 4; ++k) {
      Quaterniond plus = q;
      Quaterniond minus = q;
      plus.coeffs()(k) += kDelta;
      minus.coeffs()(k) -= kDelta;
      const Vector3d d = (direction(plus) - direction(minus)) / (2 * kDelta);
      EXPECT_LT((direction_jacobian(q).col(k) - d).norm(), 1e-8);
    }
  }
}

TEST(Direction, StaysOnTheSphereAndMovesInItsTangent) {
  std::srand(8);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Quaterniond q = Quaterniond::UnitRandom();
    EXPECT_LT((direction(q) - q * Vector3d::UnitZ()).norm(), 1e-12);
    for (int k = 0; k < 2; ++k) {
      const Vector2d h = kDelta * Vector2d::Unit(k);
      const Eigen::Vector4d d =
          (direction_plus(q, h).coeffs() - direction_plus(q, -h).coeffs()) / (2 * kDelta);
      EXPECT_LT((direction_plus_jacobian(q).col(k) - d).norm(), 1e-8);
      const Vector3d dn = direction_jacobian(q) * d;
      EXPECT_NEAR(dn.norm(), 1, 1e-6);
      EXPECT_NEAR(dn.dot(direction(q)), 0, 1e-6);
    }
  }
}

TEST(Direction, MinusUndoesPlus) {
  std::srand(9);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Quaterniond q = Quaterniond::UnitRandom();
    const Vector2d u = 1.5 * Vector2d::Random();
    EXPECT_LT((direction_minus(direction_plus(q, u), q) - u).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace gpo
