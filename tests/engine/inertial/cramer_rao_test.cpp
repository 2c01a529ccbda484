// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Compares errors of gravity and scale with the Cramér-Rao bound.
#include "engine/geometry/statistics.h"
#include "engine/inertial/alignment_problem.h"
#include "engine/inertial/inertial_alignment.h"
#include "simulated_motion.h"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

struct Bound {
  Eigen::Matrix2d gravity;  ///< covariance of its two tangents [rad^2]
  double log_scale = 0;     ///< standard deviation
};

/// Bound with the priors of bias and lever (van Trees).
Bound bound_of(ReportTimer pace, const SimulatedSensor& sensor, double seconds, unsigned seed) {
  const auto exact = simulated_alignment(pace, sensor, seconds, seed, 0);
  const AlignmentProblem problem = simulated_problem(
      exact, *exact.poses.bias_rad_s, {sensor.gyroscope_density, sensor.accelerometer_density});
  const AlignmentState truth = true_state(exact);
  const auto of_residuals = residual_noise(problem, truth);
  const MatrixXd J = of_residuals->covariance.matrixL().solve(
      jacobian(problem, truth, exact.scale * problem.centers));
  MatrixXd information = J.transpose() * J;
  information.diagonal().segment<3>(6).array() += std::pow(sensor.accelerometer_bias_sigma, -2);
  information.diagonal().segment<3>(9).array() +=
      std::pow(exact.options.calibrated_lever_sigma_m, -2);
  const MatrixXd covariance = information.inverse();
  return {covariance.block<2, 2>(3, 3), std::sqrt(covariance(kScaleUnknown, kScaleUnknown))};
}

// Medians of errors in units of the bound, relative to those of Rayleigh and normal distributions.
double gravity_ratio(const std::vector<double>& errors) {
  return median(errors) / kMedianOfRayleigh;
}
double scale_ratio(const std::vector<double>& errors) { return median(errors) / 0.6745; }

TEST(InertialAlignment, MediansAreNearTheCramerRaoBound) {
  constexpr int kSeeds = 40;
  unsigned seed = 20000;
  std::vector<double> all_of_gravity, all_of_scale;
  for (const SimulatedSensor& sensor : {kPhone, kEuroc}) {
    for (const ReportTimer pace : {ReportTimer::gentle, ReportTimer::brisk}) {
      for (const double seconds : {1, 2, 4}) {
        std::vector<double> of_gravity, of_scale;
        for (int k = 0; k < kSeeds; ++k, ++seed) {
          const auto made = simulated_alignment(pace, sensor, seconds, seed);
          const auto result =
              align_inertial(made.poses, made.gyroscope, made.T_body_camera, made.options);
          ASSERT_TRUE(result.ok) << result.reason;
          const Bound bound = bound_of(pace, sensor, seconds, seed);
          const Eigen::Vector2d error = normal_tangents(made.gravity.normalized()).transpose() *
                                        result.gravity_m_s2.normalized();
          of_gravity.push_back(std::sqrt(error.dot(bound.gravity.inverse() * error)));
          of_scale.push_back(std::abs(std::log(result.scale / made.scale)) / bound.log_scale);
        }
        // Medians of 40 errors scatter by a fifth.
        EXPECT_LT(gravity_ratio(of_gravity), 1.6) << seconds;
        EXPECT_LT(scale_ratio(of_scale), 1.6) << seconds;
        all_of_gravity.insert(all_of_gravity.end(), of_gravity.begin(), of_gravity.end());
        all_of_scale.insert(all_of_scale.end(), of_scale.begin(), of_scale.end());
      }
    }
  }
  EXPECT_LT(gravity_ratio(all_of_gravity), 1.1);
  EXPECT_LT(scale_ratio(all_of_scale), 1.1);
  RecordProperty("gravity", std::to_string(gravity_ratio(all_of_gravity)));
  RecordProperty("scale", std::to_string(scale_ratio(all_of_scale)));
}

}  // namespace
}  // namespace gpo
