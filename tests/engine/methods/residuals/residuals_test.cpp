// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/plane.h"
#include "engine/methods/residuals/ceres_solver.h"
#include "engine/methods/residuals/point_view.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Quaterniond, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kStep = 1e-6;

struct ViewCase {
  Intrinsics intrinsics;
  Quaterniond q;
  Vector3d p, normal;
  Vector2d pixel;
  double rho;
};

ViewCase random_case(unsigned seed) {
  std::srand(seed);
  ViewCase c;
  c.intrinsics.K << 480, 2, 310, 0, 500, 250, 0, 0, 1;
  c.intrinsics.K_inverse = c.intrinsics.K.inverse();
  c.q = Quaterniond(so3_exp(0.3 * Vector3d::Random()));
  c.p = 0.3 * Vector3d::Random();
  c.normal = (Vector3d(0, 0, -1) + 0.5 * Vector3d::Random()).normalized();
  c.pixel = Vector2d(310, 250) + 200 * Vector2d::Random();
  c.rho = 1 + 0.5 * Vector2d::Random().x();
  return c;
}

/// Returns the central difference of f at zero.
template <class Function>
auto difference(const Function& f) {
  return ((f(kStep) - f(-kStep)) / (2 * kStep)).eval();
}

void expect_near(const Vector2d& analytic, const Vector2d& numeric) {
  EXPECT_LT((analytic - numeric).norm(), 1e-6 * std::max(1.0, numeric.norm()));
}

TEST(PointView, MatchesProjectionOfPointAndFiniteDifferences) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const ViewCase c = random_case(seed);
    const PointView view = view_point(c.intrinsics, c.q, c.p, c.pixel, c.rho);
    const Vector3d point = c.intrinsics.K_inverse * c.pixel.homogeneous() / c.rho;
    const Vector3d seen = c.intrinsics.K * to_camera({c.q.toRotationMatrix(), c.p}, point);
    EXPECT_LT((view.pixel - seen.hnormalized()).norm(), 1e-9);
    EXPECT_TRUE(view.in_front);
    for (int k = 0; k < 3; ++k) {
      expect_near(view.d_position.col(k), difference([&](double h) -> Vector2d {
                    const Vector3d p = c.p + h * Vector3d::Unit(k);
                    return view_point(c.intrinsics, c.q, p, c.pixel, c.rho).pixel;
                  }));
      const auto turned = [&](double h) {
        return Quaterniond(Eigen::AngleAxisd(h, Vector3d::Unit(k))) * c.q;
      };
      const Eigen::Vector4d d_q =
          difference([&](double h) -> Eigen::Vector4d { return turned(h).coeffs(); });
      expect_near(view.d_rotation * d_q, difference([&](double h) -> Vector2d {
                    return view_point(c.intrinsics, turned(h), c.p, c.pixel, c.rho).pixel;
                  }));
    }
    for (int k = 0; k < 2; ++k)
      expect_near(view.d_pixel_1.col(k), difference([&](double h) -> Vector2d {
                    const Vector2d pixel = c.pixel + h * Vector2d::Unit(k);
                    return view_point(c.intrinsics, c.q, c.p, pixel, c.rho).pixel;
                  }));
    expect_near(view.d_inverse_depth, difference([&](double h) -> Vector2d {
                  return view_point(c.intrinsics, c.q, c.p, c.pixel, c.rho + h).pixel;
                }));
  }
}

TEST(PointView, DetectsPointBehindCamera) {
  const ViewCase c = random_case(1);
  EXPECT_FALSE(view_point(c.intrinsics, c.q, {0, 0, 2}, c.pixel, 1).in_front);
}

TEST(PlaneDepth, MatchesIntersectionWithPlaneAndFiniteDifferences) {
  using Vector1d = Eigen::Matrix<double, 1, 1>;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const ViewCase c = random_case(seed);
    const PlaneDepth depth = depth_on_plane(c.intrinsics, c.normal, c.pixel);
    const Vector3d ray = c.intrinsics.K_inverse * c.pixel.homogeneous();
    const auto point = intersect({c.normal, 1}, Pose{}, ray);
    ASSERT_TRUE(point);
    EXPECT_NEAR(depth.inverse_depth, 1 / point->z(), 1e-9);
    const auto rho = [&](const Vector3d& normal, const Vector2d& pixel) {
      return Vector1d(depth_on_plane(c.intrinsics, normal, pixel).inverse_depth);
    };
    for (int k = 0; k < 3; ++k) {
      const Vector1d d = difference(
          [&](double h) -> Vector1d { return rho(c.normal + h * Vector3d::Unit(k), c.pixel); });
      EXPECT_NEAR(depth.d_normal(k), d.x(), 1e-6);
    }
    for (int k = 0; k < 2; ++k) {
      const Vector1d d = difference(
          [&](double h) -> Vector1d { return rho(c.normal, c.pixel + h * Vector2d::Unit(k)); });
      EXPECT_NEAR(depth.d_pixel_1(k), d.x(), 1e-8);
    }
  }
}

Quaterniond plus(const Quaterniond& q, const Vector2d& u) {
  Quaterniond moved;
  DirectionManifold().Plus(q.coeffs().data(), u.data(), moved.coeffs().data());
  return moved;
}

TEST(Direction, StaysOnSphereAndMatchesFiniteDifferences) {
  std::srand(7);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Quaterniond q = Quaterniond::UnitRandom();
    EXPECT_LT((direction(q) - q * Vector3d::UnitZ()).norm(), 1e-12);
    for (int k = 0; k < 4; ++k) {
      Quaterniond more = q;
      Quaterniond less = q;
      more.coeffs()(k) += kStep;
      less.coeffs()(k) -= kStep;
      const Vector3d d = (direction(more) - direction(less)) / (2 * kStep);
      EXPECT_LT((direction_jacobian(q).col(k) - d).norm(), 1e-8);
    }
    RowMajor<4, 2> J;
    DirectionManifold().PlusJacobian(q.coeffs().data(), J.data());
    for (int k = 0; k < 2; ++k) {
      const Vector2d h = kStep * Vector2d::Unit(k);
      const Eigen::Vector4d d = (plus(q, h).coeffs() - plus(q, -h).coeffs()) / (2 * kStep);
      EXPECT_LT((J.col(k) - d).norm(), 1e-8);
      const Vector3d dn = direction_jacobian(q) * d;
      EXPECT_NEAR(dn.norm(), 1, 1e-6);
      EXPECT_NEAR(dn.dot(direction(q)), 0, 1e-6);
    }
    const Vector2d u = 1.5 * Vector2d::Random();
    Vector2d back;
    DirectionManifold().Minus(plus(q, u).coeffs().data(), q.coeffs().data(), back.data());
    EXPECT_LT((back - u).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace gpo
