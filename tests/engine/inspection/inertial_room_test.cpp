// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Gravity and metric scale of a real flight, compared with motion capture, and of a rendered room.
#include "engine/geometry/plane.h"
#include "engine/geometry/statistics.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <cmath>
#include <memory>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace gpo {
namespace {

class InertialRoom : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    const bool real = GetParam();
    const auto folder =
        real ? std::filesystem::path(GPO_SHARED_DIR) / "data/euroc-room" : small_room();
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
    inspector_ = std::make_unique<Inspector>(open_recording(folder));
  }
  std::shared_ptr<const Inspection> inspected(const Settings& settings) {
    return inspector_->inspect(settings);
  }
  std::unique_ptr<Inspector> inspector_;
};

INSTANTIATE_TEST_SUITE_P(Recordings, InertialRoom, testing::Bool(), [](const auto& info) {
  return info.param ? "Real" : "Rendered";
});

TEST_P(InertialRoom, DeterminesGravityAndScaleFromTwoSeconds) {
  std::vector<double> errors_percent;
  for (const int start : {0, 5, 10, 15, 20}) {
    const auto inspection = inspected({.start = start, .frames = 40});
    ASSERT_TRUE(inspection->inertial && inspection->inertial->ok) << start;
    const InertialAlignment& inertial = *inspection->inertial;
    ASSERT_TRUE(inertial.scale_known) << start;
    const Evaluation& evaluation = *inspection->evaluation;
    ASSERT_TRUE(evaluation.scale_error_percent && evaluation.gravity_error_deg) << start;
    EXPECT_LT(*evaluation.gravity_error_deg, 1.5) << start;
    EXPECT_LT(std::abs(std::log(inertial.scale / *evaluation.scale)), 3 * inertial.log_scale_sigma)
        << start;
    errors_percent.push_back(std::abs(*evaluation.scale_error_percent));
  }
  EXPECT_LT(median(errors_percent), 5);
}

TEST_P(InertialRoom, IsWithinFourSigmasAfterOneSecond) {
  int tried = 0;
  for (int start = 0; start <= 40; start += 5) {
    const auto inspection = inspected({.start = start, .frames = 20});
    if (!inspection->inertial) continue;  // no initialization
    const InertialAlignment& inertial = *inspection->inertial;
    ASSERT_TRUE(inertial.ok) << start << ": " << inertial.reason;
    ++tried;
    EXPECT_LT(std::abs(std::log(inertial.scale / *inspection->evaluation->scale)),
              4 * inertial.log_scale_sigma)
        << start;
    EXPECT_LT(*inspection->evaluation->gravity_error_deg, 4 * inertial.gravity_sigma_deg) << start;
  }
  EXPECT_GE(tried, 6);
}

TEST_P(InertialRoom, LeavesThePlaneUnchangedIfOff) {
  const Settings on{.start = 20, .frames = 20};
  const auto with = inspected(on);
  const auto without = inspected(with_setting(on, "gravity", "off"));
  EXPECT_TRUE(with->inertial);
  EXPECT_FALSE(without->inertial);
  EXPECT_FALSE(without->evaluation->gravity_error_deg);
  EXPECT_EQ(with->initialization->plane.normal, without->initialization->plane.normal);
}

TEST_P(InertialRoom, MovesPlanesWithinTheirUncertaintyIfJoint) {
  for (const int frames : {20, 40})
    for (const int start : {0, 10, 20}) {
      const Settings settings{.start = start, .frames = frames};
      const auto after = inspected(settings);
      const auto joint = inspected(with_setting(settings, "gravity", "joint"));
      const Initialization& a = *after->initialization;
      const Initialization& b = *joint->initialization;
      if (!after->inertial) continue;  // no initialization
      SCOPED_TRACE(testing::Message() << frames << " frames from " << start);
      EXPECT_FALSE(after->inertial->joint);
      ASSERT_TRUE(b.ok && joint->inertial->joint);
      const double sigma_deg = a.uncertainty->normal_sigma_deg;
      EXPECT_LT(b.uncertainty->normal_sigma_deg, sigma_deg);
      EXPECT_GT(angle_deg(a.plane.normal, b.plane.normal), 0);
      EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 4 * sigma_deg);
      EXPECT_LT(b.rms_px, 1.1 * a.rms_px);
      double parts = 0;
      for (const auto& part_deg : {b.uncertainty->neighbors_sigma_deg,
                                   b.uncertainty->bend_sigma_deg,
                                   b.uncertainty->shutter_sigma_deg,
                                   b.uncertainty->lens_sigma_deg})
        parts += std::pow(part_deg.value_or(0), 2);
      EXPECT_LE(std::sqrt(parts), b.uncertainty->normal_sigma_deg);
    }
}

// The floor of the real room is cluttered: with tracks as independent clusters the mean was 11.
TEST_P(InertialRoom, CentersAreWithinTheirCovariances) {
  double squares = 0;
  int windows = 0;
  for (int start = 0; start <= 40; start += 5) {
    const auto inspection = inspected({.start = start, .frames = 20});
    const Initialization& result = *inspection->initialization;
    if (!result.ok) continue;
    const WindowTruth& truth = *inspection->truth;
    const Pose& first = *truth.cameras.front();
    const double distance = std::abs(plane_in_camera(*truth.plane, first).distance);
    const Eigen::Vector3d center =
        first.R_wc.transpose() * (truth.cameras.back()->p_wc - first.p_wc) / distance;
    const Eigen::Vector3d error = result.cameras.back().p_wc - center;
    const Eigen::Matrix3d& covariance = result.uncertainty->center_covariances.back();
    squares += error.dot(covariance.ldlt().solve(error)) / 3;
    ++windows;
  }
  ASSERT_GT(windows, 7);
  EXPECT_LT(squares / windows, 3);
}

// The uncertainty of other methods is not that of the problem that they solved.
TEST_P(InertialRoom, IsJointOnlyForTheJointMethod) {
  const Settings after{.start = 20, .frames = 20, .options = {.method = "ba"}};
  const auto joint = inspected(with_setting(after, "gravity", "joint"));
  ASSERT_TRUE(joint->inertial && joint->inertial->ok);
  EXPECT_FALSE(joint->inertial->joint);
  EXPECT_EQ(settings_used(*joint).options.gravity, Gravity::after);
  EXPECT_EQ(joint->initialization->plane.normal, inspected(after)->initialization->plane.normal);
}

}  // namespace
}  // namespace gpo
