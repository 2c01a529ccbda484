// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/alignment_problem.h"

#include "engine/inertial/imu_intervals.h"
#include "simulated_motion.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

AlignmentProblem problem_of(const SimulatedAlignment& made, const Vector3d& gyro_bias) {
  const auto measured =
      imu_intervals(made.gyroscope, made.poses.times_ns, 0, gyro_bias, {}).between;
  AlignmentProblem problem;
  problem.path = inertial_path(measured, made.gyroscope.R_gyro_camera.transpose());
  problem.centers.resize(made.poses.center_rows());
  for (std::size_t k = 1; k < made.poses.cameras.size(); ++k)
    problem.centers.segment<3>(3 * (static_cast<Eigen::Index>(k) - 1)) = made.poses.cameras[k].p_wc;
  problem.covariance = made.poses.covariance;
  problem.inertial_noise = position_covariance(problem.path);
  problem.lever_m =
      made.gyroscope.R_gyro_camera * made.T_body_camera.R_wc.transpose() * made.T_body_camera.p_wc;
  problem.lever_sigma_m = 0.005;
  problem.bias_sigma_m_s2 = 0.1;
  return problem;
}

AlignmentState true_state(const SimulatedAlignment& made, const AlignmentProblem& problem) {
  return {.velocity = made.velocities.front(),
          .gravity = made.gravity,
          .log_scale = std::log(made.scale),
          .bias = made.accelerometer_bias,
          .lever = problem.lever_m};
}

TEST(AlignmentProblem, NothingIsLeftAtTheTruth) {
  const auto made = simulated_alignment(ReportTimer::brisk, kPhone, 2, 5, 0);
  const AlignmentProblem problem = problem_of(made, *made.poses.bias_rad_s);
  const VectorXd r = residuals(problem, true_state(made, problem));
  EXPECT_LT(r.cwiseAbs().maxCoeff(), 1e-3);  // of the integration over 2 s [m]
}

TEST(AlignmentProblem, JacobiansAreThoseOfFiniteDifferences) {
  const auto made = simulated_alignment(ReportTimer::brisk, kPhone, 1, 6);
  const AlignmentProblem problem = problem_of(made, *made.poses.bias_rad_s);
  AlignmentState state = true_state(made, problem);
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
  // To first order: what an accelerometer's bias does is turned by the gyroscope's, by hundredths.
  state.bias.setZero();
  const Eigen::MatrixXd by_bias = by_gyro_bias(problem, state);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d e = kSmall * Vector3d::Unit(axis);
    const VectorXd slope = (residuals(problem_of(made, *made.poses.bias_rad_s + e), state) -
                            residuals(problem_of(made, *made.poses.bias_rad_s - e), state)) /
                           (2 * kSmall);
    EXPECT_LT((slope - by_bias.col(axis)).cwiseAbs().maxCoeff(), 1e-6) << axis;
  }
}

TEST(AlignmentProblem, LinearStartIsExactWithoutNoise) {
  const auto made = simulated_alignment(ReportTimer::gentle, kPhone, 2, 7, 0);
  const AlignmentState start = linear_start(problem_of(made, *made.poses.bias_rad_s), 9.81);
  EXPECT_NEAR(std::exp(start.log_scale), made.scale, 0.01 * made.scale);
  EXPECT_LT(angle_deg(start.gravity, made.gravity), 0.1);
  EXPECT_LT((start.velocity - made.velocities.front()).norm(), 0.01);
}

}  // namespace
}  // namespace gpo
