// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"

#include "engine/base/error.h"
#include "tests/engine/largest.h"
#include "tests/engine/test_folder.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

Camera radial_tangential_camera(std::vector<double> coefficients) {
  return {1280, 720, 1122, 1125, 666, 361, Distortion::radial_tangential, std::move(coefficients)};
}

Camera fisheye_camera(std::vector<double> coefficients = {0.0034, 0.0007, -0.0020, 0.0002}) {
  return {512, 512, 190.97, 190.95, 254.93, 256.89, Distortion::equidistant, coefficients};
}

std::vector<Camera> cameras() {
  std::vector<double> rational{0.1, -0.05, 0.001, -0.002, 0.01, 0.02, -0.01, 0.003};
  std::vector<Camera> all{{640, 480, 500, 510, 320, 240, Distortion::none, {}},
                          radial_tangential_camera({0.13729, -0.30795, -0.005645, 0.004256}),
                          radial_tangential_camera({-0.28, 0.07, 0.0002, 0.00002, -0.01}),
                          radial_tangential_camera(rational)};
  rational.insert(rational.end(), {1e-3, -2e-3, 5e-4, 1e-3});
  all.push_back(radial_tangential_camera(rational));
  rational.insert(rational.end(), {0.02, -0.03});
  all.push_back(radial_tangential_camera(rational));
  all.push_back(fisheye_camera());
  return all;
}

Eigen::Vector2d opencv_projection(const Camera& camera, const Eigen::Vector3d& point) {
  const std::vector<cv::Point3d> points{{point.x(), point.y(), point.z()}};
  cv::Mat K;
  cv::eigen2cv(intrinsic_matrix(camera), K);
  std::vector<cv::Point2d> pixels;
  if (camera.distortion == Distortion::equidistant) {
    cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), K, camera.coefficients);
  } else {
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, camera.coefficients, pixels);
  }
  return {pixels[0].x, pixels[0].y};
}

TEST(Camera, ProjectsLikeOpenCvAndUndistortIsInverseOfDistort) {
  std::srand(1);
  for (const Camera& camera : cameras()) {
    EXPECT_EQ(project(camera, Eigen::Vector3d::UnitZ()), Eigen::Vector2d(camera.cx, camera.cy));
    for (int repeat = 0; repeat < 50; ++repeat) {
      const Eigen::Vector2d ideal = 0.5 * Eigen::Vector2d::Random();
      const Eigen::Vector3d point = ideal.homogeneous();
      EXPECT_LT((project(camera, point) - opencv_projection(camera, point)).norm(), 1e-8);
    }
  }
  for (const Camera& camera : cameras())
    for (int u = 0; u < camera.width; u += 40)
      for (int v = 0; v < camera.height; v += 40) {
        const Eigen::Vector2d raw(u, v);
        const bool behind = camera.distortion == Distortion::equidistant &&
                            (raw - Eigen::Vector2d(camera.cx, camera.cy)).norm() > 1.5 * camera.fx;
        if (behind) continue;  // more than 90 degrees from the axis, outside of a pinhole camera
        EXPECT_LT((distort(camera, undistort(camera, raw)) - raw).norm(), 1e-8) << u << " " << v;
      }
}

/// r (1 + k1 r^2) increases up to r = 1 / sqrt(-3 k1), where it is 2/3 of r.
TEST(Camera, ReturnsNanBeyondValidRadius) {
  const double k1 = -0.5;
  const double fold = 1 / std::sqrt(-3 * k1);
  const Camera camera = radial_tangential_camera({k1, 0, 0, 0});
  const Eigen::Vector2d center(camera.cx, camera.cy);
  for (const double r : {0.5 * fold, 0.999 * fold}) {
    const Eigen::Vector3d point(r, 0, 1);
    const Eigen::Vector2d raw = project(camera, point);
    EXPECT_NEAR(raw.x(), camera.cx + camera.fx * r * (1 + k1 * r * r), 1e-9);
    EXPECT_LT((undistort(camera, raw) - (intrinsic_matrix(camera) * point).hnormalized()).norm(),
              1e-6);
  }
  for (const double r : {1.001 * fold, 2 * fold, 50 * fold})
    EXPECT_FALSE(project(camera, Eigen::Vector3d(0, r, 1)).allFinite()) << r;
  const Eigen::Vector2d edge(camera.fx * fold * 2 / 3, 0);
  EXPECT_TRUE(undistort(camera, center + 0.999 * edge).allFinite());
  EXPECT_FALSE(undistort(camera, center + 1.001 * edge).allFinite());
  EXPECT_TRUE(std::isnan(undistort(camera, {5000, 5000}).x()));
}

/// For a polynomial that folds back and increases again, only the first branch is valid.
TEST(Camera, IgnoresBranchBeyondFoldAndReturnsNanBeyondValidFisheyeAngle) {
  const Camera camera =
      radial_tangential_camera({-1.2, 0.5, 0, 0});  // decreases from r = 0.58 to 1.09
  EXPECT_TRUE(project(camera, {0.5, 0, 1}).allFinite());
  EXPECT_FALSE(project(camera, {0.8, 0, 1}).allFinite());
  EXPECT_FALSE(project(camera, {1.5, 0, 1}).allFinite());
  for (double x = camera.cx; x < 20000; x += 10) {
    const Eigen::Vector2d ideal = undistort(camera, {x, camera.cy});
    EXPECT_FALSE((ideal.x() - camera.cx) / camera.fx > 0.62) << x;
  }
  const Camera fisheye = fisheye_camera({-0.3, 0, 0, 0});  // increases up to theta = 1.054 rad
  EXPECT_TRUE(project(fisheye, {std::tan(1.05), 0, 1}).allFinite());
  EXPECT_FALSE(project(fisheye, {std::tan(1.06), 0, 1}).allFinite());
  const double edge = fisheye.fx * 1.0541 * 2 / 3;
  EXPECT_TRUE(undistort(fisheye, {fisheye.cx + 0.99 * edge, fisheye.cy}).allFinite());
  EXPECT_FALSE(undistort(fisheye, {fisheye.cx + 1.01 * edge, fisheye.cy}).allFinite());
}

TEST(Camera, LensRootIsARootOfTheCovariance) {
  Camera camera = radial_tangential_camera({0.1, -0.2, 0, 0});
  EXPECT_EQ(lens_root(camera).cols(), 0);
  camera.sigmas.assign(8, 0.0);
  EXPECT_EQ(lens_root(camera), Eigen::VectorXd::Zero(8));
  camera.sigmas = {1, 2, 0, 3};
  EXPECT_EQ(lens_root(camera).cols(), 3);
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(8, 2);  // positive semidefinite
  factor.col(0) << 1, 1.1, 0, -0.3, 1e-3, -4e-3, 0, 0;
  factor.col(1) << 0.1, 0, 0, 0.3, 2e-3, 3e-3, 0, 0;
  const Eigen::MatrixXd covariance = factor * factor.transpose();
  set_lens_covariance(camera, covariance);
  EXPECT_TRUE(is_covariance(from_upper_triangle(camera.covariance)));
  const Eigen::MatrixXd root = lens_root(camera);
  EXPECT_LT(test::largest(root * root.transpose() - covariance), 1e-7);
  EXPECT_EQ(camera.sigmas[1], 1.1);
}

// Compares with raw pixels undistorted by perturbed parameters and projected with the true K.
TEST(Camera, PropagatesParameterErrorsToUndistortedPixels) {
  for (Camera camera : cameras()) {
    for (std::size_t k = 0; k < 4 + camera.coefficients.size(); ++k)
      camera.sigmas.push_back(k < 4 ? 1e-3 : 1e-6);
    const Eigen::MatrixXd root = lens_root(camera);
    for (const Eigen::Vector2d& raw : {Eigen::Vector2d(200, 150), Eigen::Vector2d(330, 290)}) {
      const Eigen::Vector2d point = undistort(camera, raw);
      const Eigen::Matrix2Xd moves = undistortion_moves_px(camera, root, point);
      ASSERT_EQ(moves.cols(), static_cast<Eigen::Index>(camera.sigmas.size()));
      for (std::size_t k = 0; k < camera.sigmas.size(); ++k) {
        const auto seen_by = [&](double sign) {
          Camera off = camera;
          double* const pinhole[] = {&off.fx, &off.fy, &off.cx, &off.cy};
          (k < 4 ? *pinhole[k] : off.coefficients[k - 4]) += sign * camera.sigmas[k];
          const Eigen::Vector2d at = undistort(off, raw);
          return Eigen::Vector2d(camera.fx * (at.x() - off.cx) / off.fx + camera.cx,
                                 camera.fy * (at.y() - off.cy) / off.fy + camera.cy);
        };
        const Eigen::Vector2d move = (seen_by(1) - seen_by(-1)) / 2;
        EXPECT_LT((move - moves.col(static_cast<Eigen::Index>(k))).norm(),
                  1e-3 * move.norm() + 1e-8)
            << "parameter " << k;
      }
    }
  }
}

TEST(Camera, RejectsImpossibleParameters) {
  Camera camera = fisheye_camera();
  EXPECT_NO_THROW(check_camera(camera));
  EXPECT_TRUE(has_near_principal_point(camera));
  camera.cx = 2.0 * camera.width;
  EXPECT_FALSE(has_near_principal_point(camera));
  camera.width = camera.height = 0;
  EXPECT_TRUE(has_near_principal_point(camera));
  camera.cx = std::nan("");
  EXPECT_EQ(test::error_of([&] { check_camera(camera); }),
            "camera: cx nan, expected a finite number");
  camera.fx = 0;
  EXPECT_THROW(check_camera(camera), InputError);
  EXPECT_FALSE(is_focal_length(0));
  EXPECT_FALSE(is_focal_length(std::nan("")));
  EXPECT_FALSE(is_focal_length(2e6));
  EXPECT_FALSE(are_coefficients({0.1, std::nan("")}));
}

TEST(Camera, RejectsMoreUncertaintiesThanParameters) {
  Camera camera = fisheye_camera();
  camera.sigmas.assign(5 + camera.coefficients.size(), 1);
  EXPECT_THROW(check_camera(camera), InputError);
  EXPECT_THROW(undistortion_moves_px(camera, lens_root(camera), {300, 200}), InputError);
  camera.sigmas.clear();
  camera.covariance = {1, 0};
  EXPECT_THROW(check_camera(camera), InputError);
  EXPECT_THROW(lens_root(camera), InputError);
  camera = fisheye_camera();
  camera.height = -1;
  EXPECT_THROW(check_camera(camera), InputError);
}

}  // namespace
}  // namespace gpo
