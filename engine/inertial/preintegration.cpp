// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/preintegration.h"

#include "engine/geometry/pose.h"

namespace gpo {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The force acts in the axes halfway, R_half = R exp(w dt / 2), whose error is
// phi_half = E^T phi + (J dt / 2) n with E = exp(w dt / 2), n that of the rate; J the right
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
  const Matrix3d back = (E * E).transpose();
  const Matrix3d tilt = -R_half * skew(acceleration_m_s2);  // force by phi_half
  const Matrix3d by_gyro = tilt * (E.transpose() * sum.R_by_gyro - J_half);
  const double half_dt2 = 0.5 * dt_s * dt_s;

  // Covariance, with T what one phi does to the force: the 9 x 9 products by their blocks.
  const Matrix3d T = tilt * E.transpose();
  const Matrix3d N = tilt * J_half;
  Eigen::Matrix<double, 9, 9> A = Eigen::Matrix<double, 9, 9>::Identity();
  A.block<3, 3>(0, 0) = back;
  A.block<3, 3>(3, 0) = T * dt_s;
  A.block<3, 3>(6, 0) = T * half_dt2;
  A.block<3, 3>(6, 3) = Matrix3d::Identity() * dt_s;
  Eigen::Matrix<double, 9, 3> B;
  B << J_full, N * dt_s, N * half_dt2;
  const double q_gyro = noise.gyroscope * noise.gyroscope / dt_s;
  const double q_acc = noise.accelerometer * noise.accelerometer / dt_s;
  sum.covariance = (A * sum.covariance * A.transpose()).eval();
  sum.covariance += q_gyro * B * B.transpose();
  sum.covariance.block<3, 3>(3, 3).diagonal().array() += q_acc * dt_s * dt_s;
  sum.covariance.block<3, 3>(3, 6).diagonal().array() += q_acc * dt_s * half_dt2;
  sum.covariance.block<3, 3>(6, 3).diagonal().array() += q_acc * dt_s * half_dt2;
  sum.covariance.block<3, 3>(6, 6).diagonal().array() += q_acc * half_dt2 * half_dt2;

  const Vector3d force = R_half * acceleration_m_s2;
  sum.position += sum.velocity * dt_s + force * half_dt2;
  sum.velocity += force * dt_s;
  sum.p_by_gyro += sum.v_by_gyro * dt_s + by_gyro * half_dt2;
  sum.v_by_gyro += by_gyro * dt_s;
  sum.p_by_acc += sum.v_by_acc * dt_s - R_half * half_dt2;
  sum.v_by_acc -= R_half * dt_s;
  sum.R_by_gyro = back * sum.R_by_gyro - J_full;
  sum.R = R_half * E;
  sum.seconds += dt_s;
}

Preintegration with_biases_moved(Preintegration sum,
                                 const Vector3d& by_gyro_rad_s,
                                 const Vector3d& by_acc_m_s2) {
  sum.R = sum.R * so3_exp(sum.R_by_gyro * by_gyro_rad_s);
  sum.velocity += sum.v_by_gyro * by_gyro_rad_s + sum.v_by_acc * by_acc_m_s2;
  sum.position += sum.p_by_gyro * by_gyro_rad_s + sum.p_by_acc * by_acc_m_s2;
  return sum;
}

}  // namespace gpo
