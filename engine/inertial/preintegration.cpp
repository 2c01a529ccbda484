// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/preintegration.h"

#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gpo {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

/// Why the samples between two times are useless; empty if they are not.
std::string why_no_measurements(const Gyroscope& gyroscope,
                                std::int64_t first_ns,
                                std::int64_t last_ns) {
  if (gyroscope.timestamps_ns.size() < 2 ||
      gyroscope.accelerations_m_s2.size() != gyroscope.timestamps_ns.size())
    return "the recording has no accelerometer";
  if (std::string reason = why_not_covered(gyroscope, first_ns, last_ns); !reason.empty())
    return reason;
  // The window, and two more samples on either side.
  const std::size_t begin = std::max<std::size_t>(first_after(gyroscope, first_ns), 2) - 2;
  const std::size_t end =
      std::min(first_after(gyroscope, last_ns) + 2, gyroscope.timestamps_ns.size());
  for (std::size_t k = begin; k < end; ++k)
    if (!gyroscope.rates_rad_s[k].allFinite() || !gyroscope.accelerations_m_s2[k].allFinite())
      return "the accelerometer has values in the window that are not finite";
  return "";
}

}  // namespace

// The force acts in the axes halfway, R_half = R exp(w dt / 2), with the error
// phi_half = E^T phi + (J dt / 2) n. E = exp(w dt / 2), n the error of the rate, J the right
// Jacobian.
void advance(Preintegration& sum,
             const Vector3d& rate_rad_s,
             const Vector3d& acceleration_m_s2,
             double dt_s,
             const ImuNoise& noise) {
  const Vector3d half_turn = 0.5 * dt_s * rate_rad_s;
  const Matrix3d E = so3_exp(half_turn);
  const Matrix3d J_half = so3_right_jacobian(half_turn) * (0.5 * dt_s);
  const Matrix3d J_full = so3_right_jacobian(2 * half_turn) * dt_s;
  const Matrix3d R_half = sum.R * E;
  const Matrix3d tilt = -R_half * skew(acceleration_m_s2);  // force by phi_half
  const double half_dt2 = 0.5 * dt_s * dt_s;

  // A: derivative by the errors so far; B: by those of rate and acceleration.
  const Matrix3d T = tilt * E.transpose();
  const Matrix3d N = tilt * J_half;
  Matrix9 A = Matrix9::Identity();
  A.block<3, 3>(0, 0) = (E * E).transpose();
  A.block<3, 3>(3, 0) = T * dt_s;
  A.block<3, 3>(6, 0) = T * half_dt2;
  A.block<3, 3>(6, 3) = Matrix3d::Identity() * dt_s;
  Eigen::Matrix<double, 9, 6> B;
  B << J_full, Matrix3d::Zero(), N * dt_s, R_half * dt_s, N * half_dt2, R_half * half_dt2;
  Vector6 q;
  q.head<3>().setConstant(noise.gyroscope * noise.gyroscope / dt_s);
  q.tail<3>().setConstant(noise.accelerometer * noise.accelerometer / dt_s);
  sum.covariance = (A * sum.covariance * A.transpose()).eval();
  sum.covariance += B * q.asDiagonal() * B.transpose();
  sum.by_biases = (A * sum.by_biases).eval() - B;

  const Vector3d force = R_half * acceleration_m_s2;
  sum.position += sum.velocity * dt_s + force * half_dt2;
  sum.velocity += force * dt_s;
  sum.R = R_half * E;
  sum.seconds += dt_s;
}

Preintegration with_biases_moved(Preintegration sum,
                                 const Vector3d& by_gyro_rad_s,
                                 const Vector3d& by_acc_m_s2) {
  Vector6 moved;
  moved << by_gyro_rad_s, by_acc_m_s2;
  const Eigen::Matrix<double, 9, 1> change = sum.by_biases * moved;
  sum.R = sum.R * so3_exp(change.head<3>());
  sum.velocity += change.segment<3>(3);
  sum.position += change.tail<3>();
  return sum;
}

ImuIntervals imu_intervals(const Gyroscope& gyroscope,
                           std::span<const std::int64_t> frame_times_ns,
                           std::int64_t time_offset_ns,
                           const Vector3d& bias_rad_s,
                           const ImuNoise& noise) {
  ImuIntervals intervals;
  const auto at = [&](std::size_t i) { return frame_times_ns[i] + time_offset_ns; };
  intervals.reason = why_no_measurements(gyroscope, at(0), at(frame_times_ns.size() - 1));
  if (!intervals.reason.empty()) return intervals;
  for (std::size_t i = 1; i < frame_times_ns.size(); ++i) {
    Preintegration& sum = intervals.between.emplace_back();
    integrate(gyroscope, at(i - 1), at(i), [&](const InertialSample& mean, double dt_s) {
      advance(sum, mean.rate_rad_s - bias_rad_s, mean.acceleration_m_s2, dt_s, noise);
    });
  }
  return intervals;
}

std::optional<double> accelerometer_noise_density(const Gyroscope& gyroscope,
                                                  std::int64_t first_ns,
                                                  std::int64_t last_ns) {
  constexpr double kBlock_ns = 1e7;
  constexpr std::size_t kLeastBlocks = 12;
  const std::size_t begin = first_after(gyroscope, first_ns - 1);
  const std::size_t end = first_after(gyroscope, last_ns);
  if (end < begin + kLeastBlocks) return std::nullopt;
  const double period_ns =
      static_cast<double>(gyroscope.timestamps_ns[end - 1] - gyroscope.timestamps_ns[begin]) /
      static_cast<double>(end - begin - 1);
  const auto samples = static_cast<std::size_t>(std::max(1.0, std::round(kBlock_ns / period_ns)));
  std::vector<Vector3d> means;
  for (std::size_t k = begin; k + samples <= end; k += samples) {
    means.emplace_back(Vector3d::Zero());
    for (std::size_t i = k; i < k + samples; ++i)
      means.back() += gyroscope.accelerations_m_s2[i] / static_cast<double>(samples);
  }
  if (means.size() < kLeastBlocks) return std::nullopt;
  double squares = 0;
  for (std::size_t k = 3; k < means.size(); ++k)
    squares += (means[k] - 3 * means[k - 1] + 3 * means[k - 2] - means[k - 3]).squaredNorm();
  constexpr double kSquaredWeights = 1 + 9 + 9 + 1;
  const double variance = squares / (3 * kSquaredWeights * static_cast<double>(means.size() - 3));
  return std::sqrt(variance * 1e-9 * period_ns * static_cast<double>(samples));
}

std::vector<InertialFrame> inertial_path(std::span<const Preintegration> between,
                                         const Matrix3d& R_first) {
  std::vector<InertialFrame> path(between.size() + 1);
  path.front().R = R_first;
  for (std::size_t k = 0; k < between.size(); ++k) {
    const Preintegration& step = between[k];
    const InertialFrame& a = path[k];
    InertialFrame& b = path[k + 1];
    b.seconds = a.seconds + step.seconds;
    b.R = a.R * step.R;
    b.velocity = a.velocity + a.R * step.velocity;
    b.position = a.position + a.velocity * step.seconds + a.R * step.position;
    const Matrix9 F = moves(a, b);
    // Rotates the errors of the step into world axes.
    Matrix9 to_world = Matrix9::Zero();
    to_world.block<3, 3>(0, 0) = b.R;
    to_world.block<3, 3>(3, 3) = a.R;
    to_world.block<3, 3>(6, 6) = a.R;
    b.by_biases = F * a.by_biases + to_world * step.by_biases;
    b.covariance =
        F * a.covariance * F.transpose() + to_world * step.covariance * to_world.transpose();
  }
  return path;
}

// A rotation theta of the earlier frame rotates all later measurements.
Matrix9 moves(const InertialFrame& earlier, const InertialFrame& later) {
  const double dt = later.seconds - earlier.seconds;
  Matrix9 F = Matrix9::Identity();
  F.block<3, 3>(3, 0) = -skew(later.velocity - earlier.velocity);
  F.block<3, 3>(6, 0) = -skew(later.position - earlier.position - earlier.velocity * dt);
  F.block<3, 3>(6, 3) = dt * Matrix3d::Identity();
  return F;
}

Eigen::MatrixXd position_covariance(std::span<const InertialFrame> path) {
  const auto frames = static_cast<Eigen::Index>(path.size());
  Eigen::MatrixXd all(3 * (frames - 1), 3 * (frames - 1));
  for (Eigen::Index i = 1; i < frames; ++i) {
    const Eigen::Matrix<double, 9, 3> of = path[i].covariance.rightCols<3>();
    for (Eigen::Index j = i; j < frames; ++j) {
      const double dt = path[j].seconds - path[i].seconds;
      const Vector3d lever = path[j].position - path[i].position - path[i].velocity * dt;
      const Matrix3d ji =
          of.bottomRows<3>() + dt * of.middleRows<3>(3) - skew(lever) * of.topRows<3>();
      all.block<3, 3>(3 * (j - 1), 3 * (i - 1)) = ji;
      all.block<3, 3>(3 * (i - 1), 3 * (j - 1)) = ji.transpose();
    }
  }
  return all;
}

}  // namespace gpo
