// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"
#include "tests/engine/desk.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

constexpr double kScale = 0.75;

/// Returns the desk with the calibration of images `factor` times as large, with correlations or
/// only standard deviations.
std::shared_ptr<const Recording> calibrated_desk(double factor, bool correlated = false) {
  Recording recording = *desk();
  Camera& camera = recording.camera;
  camera.fx *= factor;
  camera.fy *= factor;
  camera.cx = (camera.cx + 0.5) * factor - 0.5;
  camera.cy = (camera.cy + 0.5) * factor - 0.5;
  Eigen::VectorXd sigmas = Eigen::VectorXd::Constant(4 + std::ssize(camera.coefficients), 1e-3);
  sigmas.head(4).setConstant(factor);
  Eigen::MatrixXd covariance = sigmas.cwiseAbs2().asDiagonal();
  covariance(0, 4) = covariance(4, 0) = 0.5 * sigmas[0] * sigmas[4];
  set_lens_covariance(camera, covariance);
  if (!correlated) camera.covariance.clear();
  return std::make_shared<const Recording>(recording);
}

TEST(IntrinsicsScale, IsProposedForImagesThatWereResized) {
  const auto resized = Inspector(calibrated_desk(1 / kScale)).inspect({.frames = 12});
  const Finding* found = find_finding(resized->findings, "implausible-intrinsics");
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->command, "set intrinsics_scale 0.75");
  EXPECT_NE(resized->initialization->verdict->readiness, Readiness::ready);
}

TEST(IntrinsicsScale, GivesTheCameraOfTheImages) {
  const auto right = Inspector(calibrated_desk(1)).inspect({.frames = 12});
  Inspector inspector(calibrated_desk(1 / kScale));
  const auto wrong = inspector.inspect({.frames = 12});
  const auto scaled = inspector.inspect({.frames = 12, .intrinsics_scale = kScale});
  const Camera &camera = scaled->recording->camera, &wanted = desk()->camera;
  EXPECT_NEAR(camera.fx, wanted.fx, 1e-9);
  EXPECT_NEAR(camera.fy, wanted.fy, 1e-9);
  EXPECT_NEAR(camera.cx, wanted.cx, 1e-9);
  EXPECT_NEAR(camera.cy, wanted.cy, 1e-9);
  EXPECT_EQ(camera.width, wanted.width);
  for (std::size_t k = 0; k < camera.sigmas.size(); ++k)
    EXPECT_NEAR(camera.sigmas[k], k < 4 ? 1 : 1e-3, 1e-12);
  EXPECT_LT(angle_deg(scaled->initialization->plane.normal, right->initialization->plane.normal),
            1e-6);
  EXPECT_GT(angle_deg(wrong->initialization->plane.normal, right->initialization->plane.normal), 1);
  EXPECT_EQ(find_finding(scaled->findings, "implausible-intrinsics"), nullptr);
  const auto again = inspector.inspect({.frames = 12});
  EXPECT_EQ(again->recording->camera, wrong->recording->camera);
  EXPECT_EQ(again->initialization->plane.normal, wrong->initialization->plane.normal);
}

TEST(IntrinsicsScale, ScalesCovariances) {
  const auto scaled = Inspector(calibrated_desk(1 / kScale, true))
                          .inspect({.frames = 2, .intrinsics_scale = kScale});
  const auto wanted = from_upper_triangle(calibrated_desk(1, true)->camera.covariance);
  const Camera& camera = scaled->recording->camera;
  EXPECT_TRUE(from_upper_triangle(camera.covariance).isApprox(wanted, 1e-12));
  EXPECT_NEAR(camera.sigmas[0], 1, 1e-12);
}

}  // namespace
}  // namespace gpo::test
