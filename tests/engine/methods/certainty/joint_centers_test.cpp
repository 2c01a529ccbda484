// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/solution_moves.h"
#include "engine/methods/certainty/uncertainty.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

TEST(JointCenters, HaveEachCentersOwnCovarianceAndTheBias) {
  SimulationOptions options{.motion = Motion::wander, .frames = 20, .seed = 3};
  options.gyro_bias_rad_s = 0;
  options.gyro_noise_rad_s = 0.002;
  const Simulation truth = with_fitted_homographies(simulate(options));
  for (const RotationModel rotations :
       {RotationModel::known, RotationModel::bias, RotationModel::free}) {
    const auto u =
        uncertainty_of(truth.window, truth.plane, truth.cameras, rotations, Centers::jointly);
    ASSERT_TRUE(u);
    const Eigen::MatrixXd& all = u->joint_covariance;
    EXPECT_EQ(u->joint_bias_rows, rotations == RotationModel::free ? 0 : 3);
    ASSERT_EQ(all.rows(), 3 * 19 + u->joint_bias_rows + 2);
    for (int i = 1; i < 20; ++i) {
      const Eigen::Matrix3d& one = u->center_covariances[i];
      EXPECT_LT((all.block<3, 3>(3 * i - 3, 3 * i - 3) - one).norm(), 1e-6 * one.norm()) << i;
    }
    EXPECT_LT((all - all.transpose()).norm(), 1e-12 * all.norm());
    if (u->bias_covariance) {
      EXPECT_LT((all.block<3, 3>(57, 57) - *u->bias_covariance).norm(),
                1e-6 * u->bias_covariance->norm());
    }
    // Neighbors share what is not known of the normal and the bias: how far the last camera is from
    // the one before is better known than where it is. Rotations that are free are each frame's
    // own.
    const double last = all.block<3, 3>(54, 54).trace();
    const double between =
        last + all.block<3, 3>(51, 51).trace() - 2 * all.block<3, 3>(51, 54).trace();
    if (rotations != RotationModel::free) {
      EXPECT_LT(between, last);
    }
    EXPECT_GT(between, 0);
  }
}

TEST(JointCenters, AreNotComputedUnlessAskedFor) {
  const Simulation truth = with_fitted_homographies(simulate({.frames = 10}));
  const auto u = uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::known);
  ASSERT_TRUE(u);
  EXPECT_EQ(u->joint_covariance.size(), 0);
}

}  // namespace
}  // namespace gpo::test
