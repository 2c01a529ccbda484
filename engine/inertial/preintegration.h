// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo {

/// White noise of an inertial sensor.
struct ImuNoise {
  double gyroscope = 3e-4;      ///< density [rad/s/sqrt(Hz)]
  double accelerometer = 2e-3;  ///< density [m/s^2/sqrt(Hz)]
};

/// What an inertial sensor measured between two times, on the manifold (Forster et al.,
/// "On-Manifold Preintegration for Real-Time Visual-Inertial Odometry", 2017), in its axes at the
/// first time; gravity is not taken off:
///   R_2 = R_1 R,   v_2 = v_1 + g dt + R_1 velocity,   p_2 = p_1 + v_1 dt + g dt^2 / 2 + R_1
///   position
/// and with other biases, to first order,
///   R exp(R_by_gyro db_g),   velocity + v_by_gyro db_g + v_by_acc db_a,   likewise position.
struct Preintegration {
  double seconds = 0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();      ///< axes at the end -> at the start
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< [m]
  Eigen::Matrix3d R_by_gyro = Eigen::Matrix3d::Zero();  ///< [s]
  Eigen::Matrix3d v_by_gyro = Eigen::Matrix3d::Zero();  ///< [m/s / (rad/s)]
  Eigen::Matrix3d v_by_acc = Eigen::Matrix3d::Zero();   ///< [s]
  Eigen::Matrix3d p_by_gyro = Eigen::Matrix3d::Zero();  ///< [m / (rad/s)]
  Eigen::Matrix3d p_by_acc = Eigen::Matrix3d::Zero();   ///< [s^2]
  /// Of (phi, velocity, position), with R exp(phi).
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
};

/// Goes on by `dt_s` with the step's mean rate and specific force, biases taken off, the force in
/// the axes halfway through the step.
void advance(Preintegration& sum,
             const Eigen::Vector3d& rate_rad_s,
             const Eigen::Vector3d& acceleration_m_s2,
             double dt_s,
             const ImuNoise& noise);

/// The same measurements with other biases, to first order.
Preintegration with_biases_moved(Preintegration sum,
                                 const Eigen::Vector3d& by_gyro_rad_s,
                                 const Eigen::Vector3d& by_acc_m_s2);

}  // namespace gpo
