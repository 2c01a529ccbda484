// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/preintegration.h"

#include "simulated_motion.h"
#include "tests/engine/largest.h"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector3d, testing::HasSubstr;
using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr double kStep_s = 0.005;
const Vector3d kGravity(0, 0, -9.81);

struct Measured {
  std::vector<Vector3d> rates, forces;
};

Measured some_measurements(int steps) {
  std::mt19937 dice(4);
  std::normal_distribution<double> normal;
  const auto drawn = [&] { return Vector3d(normal(dice), normal(dice), normal(dice)); };
  Measured all;
  for (int k = 0; k < steps; ++k) {
    all.rates.emplace_back(1.5 * drawn());
    all.forces.emplace_back(Vector3d(1, -8, 4) + 3 * drawn());
  }
  return all;
}

Preintegration integrated(const Measured& measured,
                          const Vector3d& gyro_bias = Vector3d::Zero(),
                          const Vector3d& acc_bias = Vector3d::Zero(),
                          const ImuNoise& noise = {}) {
  Preintegration sum;
  for (std::size_t k = 0; k < measured.rates.size(); ++k)
    advance(sum, measured.rates[k] - gyro_bias, measured.forces[k] - acc_bias, kStep_s, noise);
  return sum;
}

/// (phi, velocity, position) from one to the other.
Vector9 difference(const Preintegration& from, const Preintegration& to) {
  Vector9 d;
  d << so3_log(from.R.transpose() * to.R), to.velocity - from.velocity, to.position - from.position;
  return d;
}

TEST(Preintegration, BiasJacobiansAgreeWithFiniteDifferences) {
  const Measured measured = some_measurements(60);
  const Preintegration at = integrated(measured);
  constexpr double kSmall = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d e = kSmall * Vector3d::Unit(axis);
    const Vector9 by_gyro =
        (difference(at, integrated(measured, e)) - difference(at, integrated(measured, -e))) /
        (2 * kSmall);
    EXPECT_LT((by_gyro - at.by_biases.col(axis)).norm(), 1e-7);
    const Vector9 by_acc = difference(at, integrated(measured, Vector3d::Zero(), e)) / kSmall;
    EXPECT_LT((by_acc - at.by_biases.col(3 + axis)).norm(), 1e-7);
  }
}

TEST(Preintegration, FirstOrderStepAgreesWithOtherBiases) {
  const Measured measured = some_measurements(40);
  const Preintegration at = integrated(measured);
  const Vector3d gyro(0.002, -0.003, 0.001);
  const Vector3d acc(0.1, -0.05, 0.2);
  const Preintegration again = integrated(measured, gyro, acc);
  const double moved = difference(at, again).norm();
  EXPECT_GT(moved, 0.01);
  EXPECT_LT(difference(with_biases_moved(at, gyro, acc), again).norm(), 1e-3 * moved);
}

// Draws noise for every step, 4000 times.
TEST(Preintegration, CovarianceAgreesWithDrawnNoise) {
  const Measured measured = some_measurements(20);
  const ImuNoise noise{.gyroscope = 1e-3, .accelerometer = 5e-3};
  const Preintegration at = integrated(measured, Vector3d::Zero(), Vector3d::Zero(), noise);
  std::mt19937 dice(1);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 4000;
  Eigen::Matrix<double, 9, 9> found = Eigen::Matrix<double, 9, 9>::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Measured noisy = measured;
    const auto add = [&](Vector3d& to, double density) {
      for (double& x : to) x += density / std::sqrt(kStep_s) * normal(dice);
    };
    for (Vector3d& rate : noisy.rates) add(rate, noise.gyroscope);
    for (Vector3d& force : noisy.forces) add(force, noise.accelerometer);
    const Vector9 d = difference(at, integrated(noisy));
    found += d * d.transpose() / kDraws;
  }
  const Vector9 sigmas = at.covariance.diagonal().cwiseSqrt();
  const Eigen::Matrix<double, 9, 9> error = sigmas.cwiseInverse().asDiagonal() *
                                            (found - at.covariance) *
                                            sigmas.cwiseInverse().asDiagonal();
  EXPECT_LT(test::largest(error), 0.1);
}

TEST(Preintegration, FollowsAnAnalyticPath) {
  const SimulatedMotion motion = simulated_motion(Pace::brisk, 3);
  double error_before_m = 0;
  for (const int steps : {100, 200, 400}) {
    const double dt = 1.0 / steps;
    Preintegration sum;
    for (int k = 0; k < steps; ++k) {
      const auto force = [&](double t) -> Vector3d {
        return motion.rotation(t).transpose() * (motion.acceleration(t) - kGravity);
      };
      const double t = k * dt;
      const Vector3d rate = 0.5 * (motion.rate(t) + motion.rate(t + dt));
      advance(sum, rate, 0.5 * (force(t) + force(t + dt)), dt, {});
    }
    const Eigen::Matrix3d R = motion.rotation(0);
    const Vector3d p = motion.position(0) + motion.velocity(0) + 0.5 * kGravity + R * sum.position;
    const Vector3d v = motion.velocity(0) + kGravity + R * sum.velocity;
    const double error_m = (p - motion.position(1)).norm();
    EXPECT_LT(so3_log((R * sum.R).transpose() * motion.rotation(1)).norm(), 0.5 * dt * dt);
    EXPECT_LT((v - motion.velocity(1)).norm(), 20 * dt * dt);
    EXPECT_LT(error_m, 10 * dt * dt);
    if (steps > 100) {
      EXPECT_LT(error_m, 0.3 * error_before_m);  // second order: a quarter
    }
    error_before_m = error_m;
  }
}

TEST(InertialPath, AgreesWithOneIntegrationOverAllIntervals) {
  const Measured measured = some_measurements(40);
  const Preintegration whole = integrated(measured);
  std::vector<Preintegration> parts;
  for (int part = 0; part < 4; ++part) {
    const auto of = [&](const std::vector<Vector3d>& all) {
      return std::vector<Vector3d>(all.begin() + 10 * part, all.begin() + 10 * part + 10);
    };
    parts.push_back(integrated({of(measured.rates), of(measured.forces)}));
  }
  const Eigen::Matrix3d R = so3_exp({0.3, -1, 0.5});
  const std::vector<InertialFrame> path = inertial_path(parts, R);
  const InertialFrame& last = path.back();
  EXPECT_NEAR(last.seconds, whole.seconds, 1e-12);
  EXPECT_LT((last.R - R * whole.R).norm(), 1e-12);
  EXPECT_LT((last.velocity - R * whole.velocity).norm(), 1e-12);
  EXPECT_LT((last.position - R * whole.position).norm(), 1e-12);
  EXPECT_LT((last.by_biases.topLeftCorner<3, 3>() - last.R * whole.by_biases.topLeftCorner<3, 3>())
                .norm(),
            1e-12);
  EXPECT_LT((last.by_biases.block<3, 3>(6, 0) - R * whole.by_biases.block<3, 3>(6, 0)).norm(),
            1e-12);
  EXPECT_LT((last.by_biases.block<3, 3>(6, 3) - R * whole.by_biases.block<3, 3>(6, 3)).norm(),
            1e-12);
  EXPECT_LT((last.covariance.bottomRightCorner<3, 3>() -
             R * whole.covariance.bottomRightCorner<3, 3>() * R.transpose())
                .norm(),
            1e-12);
  const Eigen::MatrixXd positions = position_covariance(path);
  EXPECT_LT((positions - positions.transpose()).norm(), 1e-18);
  EXPECT_LT(
      (positions.bottomRightCorner<3, 3>() - last.covariance.bottomRightCorner<3, 3>()).norm(),
      1e-15);
  // The error of an earlier frame includes that of its velocity.
  EXPECT_LT((positions.block<3, 3>(9, 0) -
             (moves(path[1], path[4]) * path[1].covariance).bottomRightCorner<3, 3>())
                .norm(),
            1e-15);
}

Gyroscope some_sensor() {
  Gyroscope sensor;
  for (int k = 0; k <= 100; ++k) {
    sensor.timestamps_ns.push_back(5000000LL * k);
    sensor.lines.push_back(k);
    sensor.rates_rad_s.emplace_back(0.1, 0, 0.001 * k);
    sensor.accelerations_m_s2.emplace_back(0.02 * k, 9.8, 0);
  }
  return sensor;
}

TEST(ImuIntervals, IntegrateBetweenSuccessiveFramesOrExplainFailures) {
  const std::vector<std::int64_t> times = {1000000, 52000000, 103500000};
  const auto between = imu_intervals(some_sensor(), times, 3000000, Vector3d::Zero(), {}).between;
  ASSERT_EQ(between.size(), 2U);
  EXPECT_NEAR(between[0].seconds, 0.051, 1e-12);
  EXPECT_NEAR(between[1].seconds, 0.0515, 1e-12);
  EXPECT_NEAR(between[0].velocity.norm(), 9.8 * 0.051, 1e-3);
  const std::vector<std::int64_t> later = {10000000, 50000000, 100000000};
  const auto reason = [&](const Gyroscope& sensor, std::int64_t offset_ns = 0) {
    return imu_intervals(sensor, later, offset_ns, Vector3d::Zero(), {}).reason;
  };
  EXPECT_EQ(reason(some_sensor()), "");
  EXPECT_THAT(reason(some_sensor(), 2000000000), HasSubstr("before the window's last frame"));
  EXPECT_THAT(reason(some_sensor(), -2000000000), HasSubstr("after the window's first frame"));
  Gyroscope sensor = some_sensor();
  sensor.accelerations_m_s2[12].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reason(sensor), "the accelerometer has values in the window that are not finite");
  sensor = some_sensor();
  for (std::size_t k = 12; k < sensor.timestamps_ns.size(); ++k)
    sensor.timestamps_ns[k] += 40000000;
  EXPECT_THAT(reason(sensor), HasSubstr("gap of 0.045 s"));
  sensor.accelerations_m_s2.clear();
  EXPECT_EQ(reason(sensor), "the recording has no accelerometer");
}

}  // namespace
}  // namespace gpo
