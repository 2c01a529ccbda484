// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"
#include "tests/engine/desk.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

constexpr double kScale = 0.75;

/// Returns the desk with the calibration of larger images, with standard deviations.
std::shared_ptr<const Recording> resized_desk(bool correlated) {
  Recording recording = *desk();
  Camera& camera = recording.camera;
  camera.fx /= kScale;
  camera.fy /= kScale;
  camera.cx = (camera.cx + 0.5) / kScale - 0.5;
  camera.cy = (camera.cy + 0.5) / kScale - 0.5;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(4 + std::ssize(camera.coefficients),
                                                         4 + std::ssize(camera.coefficients));
  covariance(0, 4) = covariance(4, 0) = 0.5;
  set_lens_covariance(camera, covariance);
  if (!correlated) camera.covariance.clear();
  return std::make_shared<const Recording>(recording);
}

TEST(IntrinsicsScale, IsProposedForImagesThatWereResized) {
  const auto resized = Inspector(resized_desk(false)).inspect({.frames = 12});
  const Finding* found = find_finding(resized->findings, "implausible-intrinsics");
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->command, "set intrinsics_scale 0.75");
  EXPECT_NE(resized->initialization->verdict->readiness, Readiness::ready);
}

TEST(IntrinsicsScale, GivesTheCameraOfTheImages) {
  const auto right = Inspector(desk()).inspect({.frames = 12});
  Inspector inspector(resized_desk(false));
  const auto wrong = inspector.inspect({.frames = 12});
  const auto scaled = inspector.inspect({.frames = 12, .intrinsics_scale = kScale});
  const Camera &camera = scaled->recording->camera, &wanted = desk()->camera;
  EXPECT_NEAR(camera.fx, wanted.fx, 1e-9);
  EXPECT_NEAR(camera.fy, wanted.fy, 1e-9);
  EXPECT_NEAR(camera.cx, wanted.cx, 1e-9);
  EXPECT_NEAR(camera.cy, wanted.cy, 1e-9);
  EXPECT_EQ(camera.width, wanted.width);
  EXPECT_THAT(std::vector(camera.sigmas.begin(), camera.sigmas.begin() + 4), testing::Each(kScale));
  EXPECT_EQ(camera.sigmas[4], 1);
  EXPECT_LT(angle_deg(scaled->initialization->plane.normal, right->initialization->plane.normal),
            1e-6);
  EXPECT_GT(angle_deg(wrong->initialization->plane.normal, right->initialization->plane.normal), 1);
  EXPECT_EQ(find_finding(scaled->findings, "implausible-intrinsics"), nullptr);
  const auto again = inspector.inspect({.frames = 12});
  EXPECT_EQ(again->recording->camera, wrong->recording->camera);
  EXPECT_EQ(again->initialization->plane.normal, wrong->initialization->plane.normal);
}

TEST(IntrinsicsScale, ScalesCovariances) {
  const auto scaled =
      Inspector(resized_desk(true)).inspect({.frames = 2, .intrinsics_scale = kScale});
  const Eigen::MatrixXd covariance = from_upper_triangle(scaled->recording->camera.covariance);
  EXPECT_DOUBLE_EQ(covariance(0, 0), kScale * kScale);
  EXPECT_DOUBLE_EQ(covariance(0, 4), 0.5 * kScale);
  EXPECT_DOUBLE_EQ(covariance(4, 4), 1);
  EXPECT_DOUBLE_EQ(scaled->recording->camera.sigmas[0], kScale);
}

}  // namespace
}  // namespace gpo::test
