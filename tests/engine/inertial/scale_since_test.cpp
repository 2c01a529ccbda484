// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/scale_since.h"

#include "simulated_motion.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

bool tells(const SimulatedAlignment& made, int count) {
  const auto aligned = align_inertial(
      first_poses(made.poses, count), made.gyroscope, made.T_body_camera, made.options);
  return aligned.ok && aligned.scale_known;
}

std::optional<int> poses_that_constrain_scale(const SimulatedAlignment& made) {
  return gpo::poses_that_constrain_scale(made.poses, made.gyroscope, made.T_body_camera, made.options);
}

TEST(FirstPoses, HaveTheCornerOfTheCovariance) {
  const auto made = simulated_alignment(ReportTimer::brisk, kPhone, 2, 1);
  const int count = static_cast<int>(made.poses.cameras.size());
  const UncertainPoses all = first_poses(made.poses, count);
  EXPECT_EQ(all.covariance, made.poses.covariance);
  const UncertainPoses five = first_poses(made.poses, 5);
  ASSERT_EQ(five.cameras.size(), 5U);
  EXPECT_EQ(five.times_ns.back(), made.poses.times_ns[4]);
  EXPECT_EQ(five.covariance.topLeftCorner(12, 12), made.poses.covariance.topLeftCorner(12, 12));
  const auto bias = made.poses.covariance.rows() - made.poses.center_rows();
  EXPECT_EQ(five.covariance.rows(), 12 + bias);
  EXPECT_EQ(five.covariance.bottomRightCorner(bias, bias),
            made.poses.covariance.bottomRightCorner(bias, bias));
}

TEST(ScaleSince, IsTheFirstLengthThatTellsTheScale) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto made = simulated_alignment(ReportTimer::brisk, kPhone, 4, seed);
    const int all = static_cast<int>(made.poses.cameras.size());
    ASSERT_TRUE(tells(made, all));
    const auto count = poses_that_constrain_scale(made);
    ASSERT_TRUE(count.has_value());
    EXPECT_LT(*count, all) << "four brisk seconds tell more than enough";
    EXPECT_TRUE(tells(made, *count));
    EXPECT_FALSE(tells(made, *count - 1));
  }
}

TEST(ScaleSince, IsNothingWhereTheWholeWindowDoesNotTellIt) {
  const auto made = simulated_alignment(ReportTimer::still, kPhone, 2, 3);
  EXPECT_FALSE(poses_that_constrain_scale(made).has_value());
}

}  // namespace
}  // namespace gpo
