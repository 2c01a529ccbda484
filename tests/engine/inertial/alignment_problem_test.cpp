// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/alignment_problem.h"

#include "simulated_motion.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

TEST(AlignmentProblem, ResidualsVanishAtTheTruth) {
  const auto made = simulated_alignment(ReportTimer::brisk, kPhone, 2, 5, 0);
  const AlignmentProblem problem = simulated_problem(made, *made.poses.bias_rad_s);
  const VectorXd r = residuals(problem, true_state(made));
  EXPECT_LT(r.cwiseAbs().maxCoeff(), 1e-3);  // error of the integration over 2 s [m]
}

TEST(AlignmentProblem, JacobiansAgreeWithFiniteDifferences) {
  const auto made = simulated_alignment(ReportTimer::brisk, kPhone, 1, 6);
  const AlignmentProblem problem = simulated_problem(made, *made.poses.bias_rad_s);
  AlignmentState state = true_state(made);
  state.lever += Vector3d(0.01, -0.02, 0.03);
  const Eigen::MatrixXd J = jacobian(problem, state, std::exp(state.log_scale) * problem.centers);
  constexpr double kSmall = 1e-5;
  for (int k = 0; k < kAlignmentUnknowns; ++k) {
    const Eigen::VectorXd step = kSmall * Eigen::VectorXd::Unit(kAlignmentUnknowns, k);
    const VectorXd slope =
        (residuals(problem, stepped(state, step)) - residuals(problem, stepped(state, -step))) /
        (2 * kSmall);
    EXPECT_LT((slope - J.col(k)).cwiseAbs().maxCoeff(), 1e-6) << k;
  }
  // Without the accelerometer's bias, whose effect depends on the gyroscope's to second order.
  state.bias.setZero();
  const Eigen::MatrixXd by_bias = by_gyro_bias(problem, state);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d e = kSmall * Vector3d::Unit(axis);
    const VectorXd slope = (residuals(simulated_problem(made, *made.poses.bias_rad_s + e), state) -
                            residuals(simulated_problem(made, *made.poses.bias_rad_s - e), state)) /
                           (2 * kSmall);
    EXPECT_LT((slope - by_bias.col(axis)).cwiseAbs().maxCoeff(), 1e-6) << axis;
  }
}

TEST(AlignmentProblem, LinearStartIsExactWithoutNoise) {
  const auto made = simulated_alignment(ReportTimer::gentle, kPhone, 2, 7, 0);
  const AlignmentState start = linear_start(simulated_problem(made, *made.poses.bias_rad_s), 9.81);
  EXPECT_NEAR(std::exp(start.log_scale), made.scale, 0.01 * made.scale);
  EXPECT_LT(angle_deg(start.gravity, made.gravity), 0.1);
  EXPECT_LT((start.velocity - made.velocities.front()).norm(), 0.01);
}

}  // namespace
}  // namespace gpo
