// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/residuals/transfer.h"

#include "engine/geometry/pose.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDelta = 1e-6;

struct TransferCase {
  Eigen::Matrix3d K = (Eigen::Matrix3d() << 480, 0, 310, 0, 500, 250, 0, 0, 1).finished();
  Eigen::Matrix3d R;
  Vector3d ray, normal, tau;
};

TransferCase random_case(std::uint64_t seed) {
  std::srand(static_cast<unsigned>(seed));
  TransferCase c;
  c.R = so3_exp(0.2 * Vector3d::Random());
  c.ray = (0.4 * Vector2d::Random()).homogeneous();
  c.normal = (Vector3d(0, 0, -1) + 0.5 * Vector3d::Random()).normalized();
  c.tau = 0.3 * Vector3d::Random();
  return c;
}

TEST(Transfer, JacobiansAgreeWithDifferences) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TransferCase c = random_case(seed);
    const Transfer t = transfer_on_plane(c.K, c.R, c.ray, c.normal, c.tau);
    for (int k = 0; k < 3; ++k) {
      const Vector3d h = kDelta * Vector3d::Unit(k);
      const auto pixel = [&](const Vector3d& n, const Vector3d& tau) {
        return transfer_on_plane(c.K, c.R, c.ray, n, tau).pixel;
      };
      const Vector2d d_n = (pixel(c.normal + h, c.tau) - pixel(c.normal - h, c.tau)) / (2 * kDelta);
      const Vector2d d_tau =
          (pixel(c.normal, c.tau + h) - pixel(c.normal, c.tau - h)) / (2 * kDelta);
      EXPECT_LT((t.d_normal.col(k) - d_n).norm(), 1e-6 * std::max(1.0, d_n.norm()));
      EXPECT_LT((t.d_tau.col(k) - d_tau).norm(), 1e-6 * std::max(1.0, d_tau.norm()));
    }
  }
}

TEST(Transfer, IsTheProjectionOfThePlanePoint) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TransferCase c = random_case(seed);
    const Vector3d point = c.ray * (-1 / c.normal.dot(c.ray));    // on n.P + 1 = 0
    const Vector3d seen = c.K * to_camera({c.R, -c.tau}, point);  // p_wc = -d tau
    const Transfer t = transfer_on_plane(c.K, c.R, c.ray, c.normal, c.tau);
    EXPECT_LT((t.pixel - seen.hnormalized()).norm(), 1e-9);
  }
}

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
