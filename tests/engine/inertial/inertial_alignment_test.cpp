// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/inertial_alignment.h"

#include "engine/geometry/plane.h"
#include "engine/geometry/statistics.h"
#include "simulated_motion.h"
#include "tests/engine/largest.h"

#include <cmath>

#include <Eigen/LU>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

InertialAlignment aligned(const SimulatedAlignment& made) {
  return align_inertial(made.poses, made.gyroscope, made.T_body_camera, made.options);
}

/// Squared error of gravity's direction by its covariance; 2 on average if that is correct.
double squared_error(const InertialAlignment& result, const Vector3d& gravity) {
  const Vector3d found = result.gravity_m_s2.normalized();
  Vector3d error = found - gravity.normalized();
  error -= found * found.dot(error);
  const Eigen::Matrix3d full = result.direction_covariance + found * found.transpose();
  return error.dot(full.inverse() * error);
}

TEST(InertialAlignment, IsExactWithoutNoise) {
  for (const Pace pace : {Pace::gentle, Pace::brisk}) {
    const auto made = simulated_alignment(pace, kPhone, 2, 21, 0);
    const InertialAlignment result = aligned(made);
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_TRUE(result.scale_known);
    EXPECT_NEAR(result.scale, made.scale, 0.002 * made.scale);
    EXPECT_LT(angle_deg(result.gravity_m_s2, made.gravity), 0.02);
    EXPECT_LT(result.accelerometer_bias_m_s2.norm(), 0.005);
    ASSERT_EQ(result.velocities_m_s.size(), made.velocities.size());
    for (std::size_t i = 0; i < made.velocities.size(); ++i)
      EXPECT_LT((result.velocities_m_s[i] - made.velocities[i]).norm(), 0.01) << i;
  }
}

TEST(InertialAlignment, AddsTheCorrectionToTheRecordedOffset) {
  auto made = simulated_alignment(Pace::brisk, kPhone, 2, 21, 0);
  const InertialAlignment without = aligned(made);
  for (std::int64_t& t_ns : made.gyroscope.timestamps_ns) t_ns += 25'000'000;
  made.gyroscope.time_offset_ns = 20'000'000;
  made.poses.time_offset_correction_s = 0.005;
  const InertialAlignment with = aligned(made);
  ASSERT_TRUE(with.ok) << with.reason;
  EXPECT_EQ(with.gravity_m_s2, without.gravity_m_s2);
  EXPECT_EQ(with.scale, without.scale);
}

void for_each_kind(const auto& test) {
  for (const SimulatedSensor& sensor : {kPhone, kEuroc})
    for (const Pace pace : {Pace::gentle, Pace::brisk})
      for (const double seconds : {1, 2, 4}) test(sensor, pace, seconds);
}

struct Statistics {
  double gravity = 0, scale = 0;  // sums of normalized squared errors
  int windows = 0, claims = 0;
};

// Tight bounds for the mean of all, wide ones for the 40 windows of each kind.
TEST(InertialAlignment, CovariancesAreCorrect) {
  constexpr int kSeeds = 40;
  Statistics all;
  int seed = 500;
  for_each_kind([&](const SimulatedSensor& sensor, Pace pace, double seconds) {
    SCOPED_TRACE(testing::Message() << static_cast<int>(pace) << " " << seconds);
    Statistics of;
    for (int k = 0; k < kSeeds; ++k, ++of.windows) {
      const auto made = simulated_alignment(pace, sensor, seconds, seed++);
      const InertialAlignment result = aligned(made);
      ASSERT_TRUE(result.ok) << result.reason;
      of.gravity += squared_error(result, made.gravity);
      if (!result.scale_known) continue;
      const double z = std::log(result.scale / made.scale) / result.log_scale_sigma;
      EXPECT_LT(std::abs(z), 4.5);
      of.scale += z * z;
      ++of.claims;
    }
    EXPECT_NEAR(of.gravity / of.windows, 2, 1.1);
    EXPECT_GT(of.claims, kSeeds / 2);
    EXPECT_NEAR(of.scale / of.claims, 1, 0.8);
    all.gravity += of.gravity;
    all.scale += of.scale;
    all.windows += of.windows;
    all.claims += of.claims;
  });
  EXPECT_NEAR(all.gravity / all.windows, 2, 0.4);
  EXPECT_NEAR(all.scale / all.claims, 1, 0.2);
}

TEST(InertialAlignment, UncertaintyCoversScaleFactorsAndTheLengthOfGravity) {
  constexpr int kSeeds = 100;
  SimulatedSensor sensor = kEuroc;
  sensor.scale_factor_sigma = 0.005;
  sensor.gravity_sigma = 0.003;
  double gravity = 0, scale = 0;
  for (int k = 0; k < kSeeds; ++k) {
    const auto made = simulated_alignment(Pace::brisk, sensor, 4, 900 + k);
    const InertialAlignment result = aligned(made);
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_GE(result.log_scale_sigma, std::hypot(0.005, 0.003));
    gravity += squared_error(result, made.gravity) / kSeeds;
    scale += std::pow(std::log(result.scale / made.scale) / result.log_scale_sigma, 2) / kSeeds;
  }
  EXPECT_LT(gravity, 3);
  EXPECT_LT(scale, 2);
}

TEST(InertialAlignment, DefaultsCoverABiasAsLargeAsEurocs) {
  constexpr int kSeeds = 60;
  SimulatedSensor sensor = kEuroc;
  sensor.accelerometer_bias_sigma = 0.5 / std::sqrt(3.0);
  double gravity = 0, scale = 0;
  int claims = 0;
  for (int k = 0; k < kSeeds; ++k) {
    const auto made = simulated_alignment(Pace::brisk, sensor, 2, 1200 + k);
    const auto result = align_inertial(made.poses, made.gyroscope, made.T_body_camera);
    ASSERT_TRUE(result.ok) << result.reason;
    gravity += squared_error(result, made.gravity) / kSeeds;
    if (!result.scale_known) continue;
    scale += std::pow(std::log(result.scale / made.scale) / result.log_scale_sigma, 2);
    ++claims;
  }
  EXPECT_LT(gravity, 3);
  EXPECT_GT(claims, kSeeds / 2);
  EXPECT_LT(scale / claims, 2);
}

TEST(InertialAlignment, RefusesPosesOfUnknownUncertainty) {
  auto made = simulated_alignment(Pace::brisk, kPhone, 1, 3);
  Initialization result;
  result.cameras = made.poses.cameras;
  Window window;
  window.timestamps_ns = made.poses.times_ns;
  window.points_px.resize(result.cameras.size());
  for (const auto& uncertainty : {std::optional<Uncertainty>(), std::optional(Uncertainty{})}) {
    result.uncertainty = uncertainty;
    made.poses = uncertain_poses(window, result);
    EXPECT_EQ(aligned(made).reason, "the uncertainty of the poses is unknown");
    EXPECT_FALSE(poses_that_determine_scale(made.poses, made.gyroscope, made.T_body_camera));
  }
}

/// Centers and the gyroscope's bias.
VectorXd stacked(const UncertainPoses& poses) {
  VectorXd all(poses.center_rows() + 3);
  for (std::size_t i = 1; i < poses.cameras.size(); ++i)
    all.segment<3>(3 * (static_cast<Eigen::Index>(i) - 1)) = poses.cameras[i].p_wc;
  all.tail<3>() = *poses.bias_rad_s;
  return all;
}

// engine/method.md, eq. 25.
TEST(InertialAlignment, PullReducesErrorsOfPosesAndBias) {
  constexpr int kSeeds = 60;
  for (const double seconds : {1, 2}) {
    double squares = 0, bias_before = 0, bias_after = 0, before = 0, after = 0;
    for (int k = 0; k < kSeeds; ++k) {
      const auto made = simulated_alignment(Pace::brisk, kPhone, seconds, 7000 + k);
      PosePull pull;
      const InertialAlignment inertial =
          align_inertial(made.poses, made.gyroscope, made.T_body_camera, made.options, &pull);
      ASSERT_TRUE(inertial.ok) << inertial.reason;
      const MatrixXd& C = made.poses.covariance;
      const VectorXd error = stacked(made.poses) - made.centers_and_bias;
      const VectorXd pulled = error - C * pull.gradient;
      const MatrixXd left = C - C * pull.information * C.transpose();
      squares += pulled.dot(left.ldlt().solve(pulled)) / static_cast<double>(pulled.size());
      const Eigen::Index rows = made.poses.center_rows();
      before += error.head(rows).squaredNorm();
      after += pulled.head(rows).squaredNorm();
      bias_before += error.tail<3>().squaredNorm();
      bias_after += pulled.tail<3>().squaredNorm();
    }
    EXPECT_NEAR(squares / kSeeds, 1, 0.1) << seconds;
    EXPECT_LT(after, before) << seconds;
    EXPECT_LT(bias_after, bias_before) << seconds;
  }
}

TEST(InertialAlignment, AtRestDeterminesGravityButNoScale) {
  Statistics of;
  for (const double seconds : {1, 2})
    for (int k = 0; k < 30; ++k, ++of.windows) {
      const auto made = simulated_alignment(Pace::still, kPhone, seconds, 3000 + k);
      const InertialAlignment result = aligned(made);
      ASSERT_TRUE(result.ok) << result.reason;
      EXPECT_FALSE(result.scale_known) << result.log_scale_sigma;
      EXPECT_EQ(result.scale_reason, "not determined: change speed or direction");
      EXPECT_LT(angle_deg(result.gravity_m_s2, made.gravity), 4);
      of.gravity += squared_error(result, made.gravity);
    }
  EXPECT_NEAR(of.gravity / of.windows, 2, 0.9);
}

TEST(InertialAlignment, EstimatesAnUncalibratedLever) {
  double squares = 0;
  constexpr int kSeeds = 20;
  for (int k = 0; k < kSeeds; ++k) {
    const auto made = simulated_alignment(Pace::brisk, kPhone, 2, 4000 + k);
    const InertialAlignment calibrated = aligned(made);
    const InertialAlignment free =
        align_inertial(made.poses, made.gyroscope, std::nullopt, made.options);
    ASSERT_TRUE(free.ok) << free.reason;
    EXPECT_GT(free.log_scale_sigma, calibrated.log_scale_sigma);
    const double z = std::log(free.scale / made.scale) / free.log_scale_sigma;
    squares += z * z / kSeeds;
  }
  EXPECT_LT(squares, 2.5);
}

template <class Change>
std::string refusal(Change change) {
  auto made = simulated_alignment(Pace::brisk, kPhone, 1, 31);
  for (Vector3d& a : made.gyroscope.accelerations_m_s2) a = change(a);
  const InertialAlignment result = aligned(made);
  EXPECT_FALSE(result.ok);
  return result.reason;
}

TEST(InertialAlignment, ExplainsWrongAccelerations) {
  EXPECT_THAT(refusal([](const Vector3d& a) -> Vector3d { return a / 9.80665; }),
              testing::HasSubstr("are its values in g?"));
  EXPECT_THAT(refusal([](const Vector3d& a) -> Vector3d { return 0.001 * a; }),
              testing::HasSubstr("the accelerometer measures 0.01 m/s^2 on average"));
  EXPECT_THAT(refusal([](const Vector3d& a) { return Vector3d(a.y(), a.z(), a.x()); }),
              testing::HasSubstr("other axes or clock?"));
  EXPECT_THAT(refusal([](const Vector3d&) -> Vector3d { return Vector3d::Constant(NAN); }),
              testing::HasSubstr("not finite"));
  auto made = simulated_alignment(Pace::brisk, kPhone, 1, 31);
  made.gyroscope.accelerations_m_s2.clear();
  EXPECT_EQ(aligned(made).reason, "the recording has no accelerometer");
  made.poses.cameras.resize(3);
  EXPECT_EQ(aligned(made).reason, "gravity and metric scale need at least 5 frames; there are 3");
}

TEST(FirstPoses, HaveTheCornerOfTheCovariance) {
  const auto made = simulated_alignment(Pace::brisk, kPhone, 2, 1);
  const MatrixXd& all = made.poses.covariance;
  EXPECT_EQ(first_poses(made.poses, static_cast<int>(made.poses.cameras.size())).covariance, all);
  const UncertainPoses five = first_poses(made.poses, 5);
  ASSERT_EQ(five.cameras.size(), 5U);
  EXPECT_EQ(five.times_ns.back(), made.poses.times_ns[4]);
  EXPECT_EQ(five.covariance.topLeftCorner(12, 12), all.topLeftCorner(12, 12));
  const auto bias = all.rows() - made.poses.center_rows();
  EXPECT_EQ(five.covariance.rows(), 12 + bias);
  EXPECT_EQ(five.covariance.bottomRightCorner(bias, bias), all.bottomRightCorner(bias, bias));
}

TEST(ScaleSince, IsTheFirstLengthThatDeterminesTheScaleIfAny) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto made = simulated_alignment(Pace::brisk, kPhone, 4, seed);
    const auto determined = [&](int count) {
      const auto result = align_inertial(
          first_poses(made.poses, count), made.gyroscope, made.T_body_camera, made.options);
      return result.ok && result.scale_known;
    };
    const int all = static_cast<int>(made.poses.cameras.size());
    ASSERT_TRUE(determined(all));
    const auto count =
        poses_that_determine_scale(made.poses, made.gyroscope, made.T_body_camera, made.options);
    ASSERT_TRUE(count.has_value());
    EXPECT_LT(*count, all) << "four brisk seconds are more than enough";
    EXPECT_TRUE(determined(*count));
    EXPECT_FALSE(determined(*count - 1));
  }
  const auto still = simulated_alignment(Pace::still, kPhone, 2, 3);
  EXPECT_FALSE(
      poses_that_determine_scale(still.poses, still.gyroscope, still.T_body_camera, still.options));
}

/// Cramér-Rao bound of gravity and scale.
struct Bound {
  Eigen::Matrix2d gravity;  ///< covariance of its two tangents [rad^2]
  double log_scale = 0;     ///< standard deviation
};

/// Bound with the priors of bias and lever (van Trees).
Bound bound_of(Pace pace, const SimulatedSensor& sensor, double seconds, unsigned seed) {
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
  for_each_kind([&](const SimulatedSensor& sensor, Pace pace, double seconds) {
    std::vector<double> of_gravity, of_scale;
    for (int k = 0; k < kSeeds; ++k, ++seed) {
      const auto made = simulated_alignment(pace, sensor, seconds, seed);
      const InertialAlignment result = aligned(made);
      ASSERT_TRUE(result.ok) << result.reason;
      const Bound bound = bound_of(pace, sensor, seconds, seed);
      const Eigen::Vector2d error =
          normal_tangents(made.gravity.normalized()).transpose() * result.gravity_m_s2.normalized();
      of_gravity.push_back(std::sqrt(error.dot(bound.gravity.inverse() * error)));
      of_scale.push_back(std::abs(std::log(result.scale / made.scale)) / bound.log_scale);
    }
    // Medians of 40 errors scatter by a fifth.
    EXPECT_LT(gravity_ratio(of_gravity), 1.6) << seconds;
    EXPECT_LT(scale_ratio(of_scale), 1.6) << seconds;
    all_of_gravity.insert(all_of_gravity.end(), of_gravity.begin(), of_gravity.end());
    all_of_scale.insert(all_of_scale.end(), of_scale.begin(), of_scale.end());
  });
  EXPECT_LT(gravity_ratio(all_of_gravity), 1.1);
  EXPECT_LT(scale_ratio(all_of_scale), 1.1);
}

TEST(AlignmentProblem, JacobiansAgreeWithFiniteDifferences) {
  const auto made = simulated_alignment(Pace::brisk, kPhone, 1, 6);
  const AlignmentProblem problem = simulated_problem(made, *made.poses.bias_rad_s);
  AlignmentState state = true_state(made);
  state.lever += Vector3d(0.01, -0.02, 0.03);
  const MatrixXd J = jacobian(problem, state, std::exp(state.log_scale) * problem.centers);
  constexpr double kSmall = 1e-5;
  for (int k = 0; k < kAlignmentUnknowns; ++k) {
    const VectorXd step = kSmall * VectorXd::Unit(kAlignmentUnknowns, k);
    const VectorXd slope =
        (residuals(problem, stepped(state, step)) - residuals(problem, stepped(state, -step))) /
        (2 * kSmall);
    EXPECT_LT(test::largest(slope - J.col(k)), 1e-6) << k;
  }
  // Without the accelerometer's bias, whose effect depends on the gyroscope's to second order.
  state.bias.setZero();
  const MatrixXd by_bias = by_gyro_bias(problem, state);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d e = kSmall * Vector3d::Unit(axis);
    const VectorXd slope = (residuals(simulated_problem(made, *made.poses.bias_rad_s + e), state) -
                            residuals(simulated_problem(made, *made.poses.bias_rad_s - e), state)) /
                           (2 * kSmall);
    EXPECT_LT(test::largest(slope - by_bias.col(axis)), 1e-6) << axis;
  }
}

TEST(AlignmentProblem, LinearStartIsExactWithoutNoise) {
  const auto made = simulated_alignment(Pace::gentle, kPhone, 2, 7, 0);
  const AlignmentState start = linear_start(simulated_problem(made, *made.poses.bias_rad_s), 9.81);
  EXPECT_NEAR(std::exp(start.log_scale), made.scale, 0.01 * made.scale);
  EXPECT_LT(angle_deg(start.gravity, made.gravity), 0.1);
  EXPECT_LT((start.velocity - made.velocities.front()).norm(), 0.01);
}

}  // namespace
}  // namespace gpo
