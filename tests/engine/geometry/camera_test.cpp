// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

Camera radial_tangential(std::vector<double> coefficients) {
  return {1280, 720, 1122, 1125, 666, 361, Distortion::radial_tangential, std::move(coefficients)};
}

Camera equidistant() {
  return {512,
          512,
          190.97,
          190.95,
          254.93,
          256.89,
          Distortion::equidistant,
          {0.0034, 0.0007, -0.0020, 0.0002}};
}

std::vector<Camera> cameras() {
  return {{640, 480, 500, 510, 320, 240, Distortion::none, {}},
          radial_tangential({0.13729, -0.30795, -0.005645, 0.004256}),
          radial_tangential({-0.28, 0.07, 0.0002, 0.00002, -0.01}),
          radial_tangential({0.1, -0.05, 0.001, -0.002, 0.01, 0.02, -0.01, 0.003}),
          equidistant()};
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

TEST(Camera, ProjectsAsOpenCvDoes) {
  std::srand(1);
  for (const Camera& camera : cameras()) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      const Eigen::Vector3d point(0.5 * Eigen::Vector2d::Random().homogeneous());
      EXPECT_LT((project(camera, point) - opencv_projection(camera, point)).norm(), 1e-8);
    }
  }
}

TEST(Camera, UndistortIsTheInverseOfDistort) {
  for (const Camera& camera : cameras()) {
    for (int u = 0; u < camera.width; u += 40) {
      for (int v = 0; v < camera.height; v += 40) {
        const Eigen::Vector2d raw(u, v);
        const bool behind = camera.distortion == Distortion::equidistant &&
                            (raw - Eigen::Vector2d(camera.cx, camera.cy)).norm() > 1.5 * camera.fx;
        if (behind) continue;  // more than 90 degrees from the axis: no pinhole camera sees it
        EXPECT_LT((distort(camera, undistort(camera, raw)) - raw).norm(), 1e-8) << u << " " << v;
      }
    }
  }
}

TEST(Camera, SaysNanWhereTheModelHasNoInverse) {
  EXPECT_TRUE(std::isnan(undistort(radial_tangential({-0.5, 0, 0, 0}), {5000, 5000}).x()));
}

TEST(Camera, PrincipalPointIsThePixelOfTheAxis) {
  for (const Camera& camera : cameras()) {
    EXPECT_EQ(project(camera, Eigen::Vector3d::UnitZ()), Eigen::Vector2d(camera.cx, camera.cy));
  }
}

}  // namespace
}  // namespace gpo
