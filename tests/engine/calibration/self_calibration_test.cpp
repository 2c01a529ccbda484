// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/self_calibration.h"

#include "engine/calibration/calibration_report.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/recording/companions/companion_files.h"
#include "tests/engine/frontend/texture.h"
#include "tests/engine/test_folder.h"

#include <cmath>
#include <memory>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Camera kFilmingCamera{
    320, 240, 290, 291, 164, 117, Distortion::radial_tangential, {0.05, -0.1, 0, 0}};

/// A hand-held camera about 1 m above z = 0 that leans by up to `lean_deg` in all directions.
Pose pose_at(double t, double lean_deg) {
  const double lean = radians(lean_deg);
  const Eigen::Matrix3d R = so3_exp(
      Vector3d(lean * std::sin(5 * t), lean * std::sin(3.7 * t + 1), 0.15 * std::sin(4 * t)));
  const Vector3d looked_at(0.25 * std::sin(3 * t), 0.2 * std::sin(2 * t + 2), 0);
  return {R, looked_at - (1 + 0.1 * std::sin(2.5 * t)) * R.col(2)};
}

/// Images of a texture on z = 0, in closed form.
FrameCache images_of(int count, double lean_deg) {
  const auto rays = std::make_shared<std::vector<Vector3d>>();
  for (int v = 0; v < kFilmingCamera.height; ++v)
    for (int u = 0; u < kFilmingCamera.width; ++u)
      rays->push_back(intrinsic_matrix(kFilmingCamera).inverse() *
                      undistort(kFilmingCamera, Vector2d(u, v)).homogeneous());
  return {
      count, [=](int i) {
        const Pose pose = pose_at(i / 30.0, lean_deg);
        const auto place = [&](const Vector2d& px) -> Vector2d {
          const Vector3d ray =
              pose.R_wc *
              (*rays)[static_cast<int>(px.y()) * kFilmingCamera.width + static_cast<int>(px.x())];
          // A texel is a pixel if the camera looks straight at the plane.
          return 290 * (pose.p_wc - ray * pose.p_wc.z() / ray.z()).head<2>();
        };
        cv::Mat bgr;
        cv::cvtColor(test::image_of({kFilmingCamera.width, kFilmingCamera.height}, place),
                     bgr,
                     cv::COLOR_GRAY2BGR);
        return bgr;
      }};
}

TEST(SelfCalibration, EstimatesTheCameraFromImagesOfAPlane) {
  const FrameCache images = images_of(60, 25);
  std::vector<std::string> steps;
  const auto found =
      calibrate_from_plane(images,
                           camera_of_view(kFilmingCamera.width, kFilmingCamera.height),
                           {},
                           [&](const char* what, int, int) {
                             if (steps.empty() || steps.back() != what) steps.emplace_back(what);
                           });
  ASSERT_TRUE(found.lens.ok) << found.lens.reason;
  EXPECT_NEAR(found.lens.camera.fx, kFilmingCamera.fx, 0.01 * kFilmingCamera.fx) << to_text(found);
  EXPECT_LT(std::abs(found.lens.camera.fx - kFilmingCamera.fx), 3 * found.lens.camera.sigmas[0])
      << to_text(found);
  EXPECT_THAT(
      steps,
      testing::ElementsAre(
          "following a plane", "finding its points in other images", "estimating the lens"));
  const test::TestFolder folder;
  const Calibration read = read_calibration(folder.write("camera.yaml", to_yaml(found, "test")));
  EXPECT_TRUE(read.self_calibrated);
  EXPECT_NEAR(read.camera.fx, found.lens.camera.fx, 1e-4);
  ASSERT_EQ(read.camera.sigmas.size(), 8);
  EXPECT_NEAR(read.camera.sigmas[0], found.lens.camera.sigmas[0], 0.01 * read.camera.sigmas[0]);
}

TEST(SelfCalibration, RefusesACameraThatKeepsItsTilt) {
  const FrameCache images = images_of(40, 1);
  const auto found =
      calibrate_from_plane(images, camera_of_view(kFilmingCamera.width, kFilmingCamera.height));
  EXPECT_FALSE(found.lens.ok);
  EXPECT_THAT(found.lens.reason, testing::HasSubstr("keeps its tilt to the plane"));
}

}  // namespace
}  // namespace gpo
