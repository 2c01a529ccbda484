// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Compares the lens models with their authors' formulas, written here with the authors' parameters.
#include "engine/base/error.h"
#include "engine/geometry/camera.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

/// The authors' projection onto the plane where fx, fy, cx, cy apply.
using Projection = std::function<Vector2d(const Vector3d& P)>;

struct LensCase {
  Camera camera;         ///< with our focal lengths
  double authors_focal;  ///< the authors' fx divided by ours
  Projection authors;
};

Vector2d brown(const Vector2d& m, double k1, double k2, double p1, double p2) {
  const double x = m.x(), y = m.y(), r2 = x * x + y * y;
  const double radial = 1 + k1 * r2 + k2 * r2 * r2;
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

LensCase double_sphere(double xi, double alpha) {
  const auto authors = [=](const Vector3d& P) {
    const double d1 = P.norm();
    const double z = xi * d1 + P.z();
    const double d2 = std::hypot(P.x(), P.y(), z);
    return Vector2d(P.head<2>() / (alpha * d2 + (1 - alpha) * z));
  };
  return {{752, 480, 460, 459, 366, 249, Distortion::double_sphere, {xi, alpha}}, 1 + xi, authors};
}

LensCase extended_unified(double alpha, double beta) {
  const auto authors = [=](const Vector3d& P) {
    const double d = std::sqrt(beta * P.head<2>().squaredNorm() + P.z() * P.z());
    return Vector2d(P.head<2>() / (alpha * d + (1 - alpha) * P.z()));
  };
  return {{752, 480, 460, 459, 366, 249, Distortion::extended_unified, {alpha, beta}}, 1, authors};
}

LensCase omnidirectional(double xi) {
  const double k1 = -0.116, k2 = 0.453, p1 = -0.00037, p2 = -0.00034;
  const auto authors = [=](const Vector3d& P) {
    const Vector3d on_sphere = P.normalized();
    return brown(on_sphere.head<2>() / (on_sphere.z() + xi), k1, k2, p1, p2);
  };
  return {{752, 480, 330, 331, 366, 249, Distortion::omnidirectional, {xi, k1, k2, p1, p2}},
          1 + xi,
          authors};
}

LensCase field_of_view(double w) {
  const auto authors = [=](const Vector3d& P) {
    const Vector2d x = P.hnormalized();
    const double r = x.norm();
    return r > 0 ? Vector2d(x * (std::atan(2 * r * std::tan(w / 2)) / w / r)) : x;
  };
  return {{752, 480, 400, 399, 366, 249, Distortion::field_of_view, {w}},
          w / (2 * std::tan(w / 2)),
          authors};
}

LensCase thin_prism() {
  const double k1 = -0.02, k2 = 0.01, p1 = 5e-4, p2 = -3e-4, k3 = -0.004, k4 = 8e-4, s1 = 1e-3,
               s2 = -2e-3;
  const auto authors = [=](const Vector3d& P) {
    const Vector2d x = P.hnormalized();
    const double theta = std::atan(x.norm());
    const Vector2d uv = x.norm() > 0 ? Vector2d(x * (theta / x.norm())) : x;
    const double u = uv.x(), v = uv.y(), r2 = u * u + v * v;
    const double radial = k1 * r2 + k2 * r2 * r2 + k3 * std::pow(r2, 3) + k4 * std::pow(r2, 4);
    return Vector2d(u + u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u) + s1 * r2,
                    v + v * radial + 2 * p2 * u * v + p1 * (r2 + 2 * v * v) + s2 * r2);
  };
  const auto kind = Distortion::thin_prism_fisheye;
  return {{752, 480, 400, 399, 366, 249, kind, {k1, k2, p1, p2, k3, k4, s1, s2}}, 1, authors};
}

std::vector<LensCase> lens_cases() {
  return {double_sphere(-0.24096, 0.566997),
          double_sphere(0.3, 0.4),
          extended_unified(0.6, 1.1),
          extended_unified(0.3, 0.8),
          omnidirectional(2.0443),
          omnidirectional(0.9),
          field_of_view(0.9207),
          thin_prism()};
}

Vector2d authors_pixel(const LensCase& one, const Vector3d& P) {
  const Vector2d m = one.authors_focal * one.authors(P);
  return {one.camera.fx * m.x() + one.camera.cx, one.camera.fy * m.y() + one.camera.cy};
}

/// Calls `visit` with the raw pixels of a grid over the image.
void for_grid(const Camera& camera, const std::function<void(const Vector2d& raw)>& visit) {
  for (int u = 0; u < camera.width; u += 25)
    for (int v = 0; v < camera.height; v += 20) visit({u, v});
}

TEST(LensModels, ProjectLikeTheAuthorsFormulasOverTheImage) {
  for (const LensCase& one : lens_cases()) {
    SCOPED_TRACE(lens_model(one.camera.distortion).name);
    int visible = 0;
    for_grid(one.camera, [&](const Vector2d& raw) {
      const Vector2d ideal = undistort(one.camera, raw);
      if (!ideal.allFinite()) return;  // more than 90 degrees from the axis
      ++visible;
      const Vector3d P = intrinsic_matrix(one.camera).inverse() * ideal.homogeneous();
      EXPECT_LT((authors_pixel(one, 2.5 * P) - raw).norm(), 1e-6) << raw.transpose();
      EXPECT_LT((project(one.camera, 2.5 * P) - raw).norm(), 1e-6) << raw.transpose();
    });
    EXPECT_GT(visible, 600);
    EXPECT_EQ(project(one.camera, {0, 0, 1}), Vector2d(one.camera.cx, one.camera.cy));
  }
}

TEST(LensModels, HaveTheFocalLengthAtThePrincipalPoint) {
  constexpr double kStep = 1e-6;
  for (const LensCase& one : lens_cases()) {
    const Vector2d center(one.camera.cx, one.camera.cy);
    for (int k = 0; k < 2; ++k) {
      const Vector2d step = kStep * Vector2d::Unit(k);
      const Vector2d slope =
          (distort(one.camera, center + step) - distort(one.camera, center - step)) / (2 * kStep);
      EXPECT_LT((slope - Vector2d::Unit(k)).norm(), 1e-6) << lens_model(one.camera.distortion).name;
    }
  }
}

TEST(LensModels, MovePixelsByErrorsOfEachParameterAsNumericDerivativesDo) {
  for (const LensCase& one : lens_cases()) {
    Camera camera = one.camera;
    camera.sigmas.assign(4 + camera.coefficients.size(), 1e-4);
    const Eigen::MatrixXd root = lens_root(camera);
    for (const Vector2d& raw : {Vector2d(200, 150), Vector2d(430, 290)}) {
      const Vector2d ideal = undistort(camera, raw);
      const Eigen::Matrix2Xd moves = undistortion_moves_px(camera, root, ideal);
      for (std::size_t k = 0; k < camera.sigmas.size(); ++k) {
        const auto seen_by = [&](double sign) {
          Camera off = camera;
          double* const pinhole[] = {&off.fx, &off.fy, &off.cx, &off.cy};
          (k < 4 ? *pinhole[k] : off.coefficients[k - 4]) += sign * camera.sigmas[k];
          const Vector2d at = undistort(off, raw);
          return Vector2d(camera.fx * (at.x() - off.cx) / off.fx + camera.cx,
                          camera.fy * (at.y() - off.cy) / off.fy + camera.cy);
        };
        const Vector2d numeric = (seen_by(1) - seen_by(-1)) / 2;
        EXPECT_LT((numeric - moves.col(static_cast<Eigen::Index>(k))).norm(),
                  1e-3 * numeric.norm() + 1e-8)
            << lens_model(camera.distortion).name << ", parameter " << k;
      }
    }
  }
}

TEST(LensModels, ReturnNanOutsideOfTheImageOfTheHalfSpace) {
  for (const LensCase& one : lens_cases())
    EXPECT_FALSE(undistort(one.camera, {1e5, 1e5}).allFinite())
        << lens_model(one.camera.distortion).name;
}

TEST(LensModels, RejectCoefficientsOutsideOfTheModel) {
  Camera camera = double_sphere(0.1, 0.5).camera;
  EXPECT_NO_THROW(check_camera(camera));
  camera.coefficients = {0.1, 1.5};
  try {
    check_camera(camera);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "camera: found alpha 1.5 outside of 0 to 1 in the lens model double-sphere");
  }
}

}  // namespace
}  // namespace gpo
