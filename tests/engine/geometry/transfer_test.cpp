// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/transfer.h"

#include "engine/geometry/plane.h"

#include <cstdint>
#include <cstdlib>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDelta = 1e-6;

struct TransferCase {
  FrameState state;
  Vector3d ray;
};

TransferCase random_case(std::uint64_t seed) {
  std::srand(static_cast<unsigned>(seed));
  TransferCase c;
  c.state.R_cw = so3_exp(0.2 * Vector3d::Random());
  c.ray = (0.4 * Vector2d::Random()).homogeneous();
  c.state.normal = (Vector3d(0, 0, -1) + 0.5 * Vector3d::Random()).normalized();
  c.state.tangents = normal_tangents(c.state.normal);
  c.state.tau_c = 0.3 * Vector3d::Random();
  c.state.fx = 480;
  c.state.fy = 500;
  return c;
}

/// Returns the pixel after a step over (normal, phi, t).
Vector2d pixel_after(const TransferCase& c, const Eigen::Matrix<double, 9, 1>& step) {
  FrameState state = c.state;
  state.normal += step.head<3>();
  const Eigen::Matrix3d turned = so3_exp(step.segment<3>(3)).transpose();
  state.R_cw = turned * state.R_cw;
  state.tau_c = turned * (state.tau_c + step.tail<3>());
  return transfer_on_plane(state, c.ray).pixel;
}

TEST(Transfer, MatchesProjectionOfPlanePointAndFiniteDifferences) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TransferCase c = random_case(seed);
    const FrameState& s = c.state;
    const Transfer t = transfer_on_plane(s, c.ray);
    const Vector3d point = c.ray * (-1 / s.normal.dot(c.ray));  // on n.P + 1 = 0
    const Vector3d seen = s.R_cw * point + s.tau_c;             // p_wc = -d tau
    const Vector2d expected(s.fx * seen.x() / seen.z(), s.fy * seen.y() / seen.z());
    EXPECT_LT((t.pixel - expected).norm(), 1e-9);
    EXPECT_EQ(t.in_front(), t.y.z() > 0);
    Eigen::Matrix<double, 2, 9> J;
    J << t.d_normal(), t.d_rotation(), t.d_translation();
    for (int k = 0; k < 9; ++k) {
      const Eigen::Matrix<double, 9, 1> h = kDelta * Eigen::Matrix<double, 9, 1>::Unit(k);
      const Vector2d d = (pixel_after(c, h) - pixel_after(c, -h)) / (2 * kDelta);
      EXPECT_LT((J.col(k) - d).norm(), 1e-6 * std::max(1.0, d.norm())) << k;
    }
    const Eigen::Matrix<double, 2, 8> all = t.jacobian(s.tangents);
    EXPECT_EQ(all.leftCols<2>(), t.d_normal() * s.tangents);
    EXPECT_EQ(all.rightCols<6>(), J.rightCols<6>());
  }
}

}  // namespace
}  // namespace gpo
