// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// White noise of an inertial sensor.
struct ImuNoise {
  double gyroscope = 3e-4;      ///< density [rad/s/sqrt(Hz)]
  double accelerometer = 2e-3;  ///< density [m/s^2/sqrt(Hz)]
};

/// Inertial measurements between two times on the manifold (Forster et al., "On-Manifold
/// Preintegration for Real-Time Visual-Inertial Odometry", 2017), in the sensor's axes at the first
/// time, gravity included:
///   R_2 = R_1 R,   v_2 = v_1 + g dt + R_1 velocity,   p_2 = p_1 + v_1 dt + g dt^2 / 2 + R_1
///   position
struct Preintegration {
  double seconds = 0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();     ///< axes at the end -> at the start
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  /// Derivatives of (phi, velocity, position) by the biases of gyroscope and accelerometer, with
  /// R exp(phi).
  Eigen::Matrix<double, 9, 6> by_biases = Eigen::Matrix<double, 9, 6>::Zero();
  /// Covariance of the same by white noise.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
};

/// Continues by `dt_s` with the step's mean rate and specific force, both without bias. The force
/// acts in the axes halfway through the step.
void advance(Preintegration& sum,
             const Eigen::Vector3d& rate_rad_s,
             const Eigen::Vector3d& acceleration_m_s2,
             double dt_s,
             const ImuNoise& noise);

/// The same measurements for other biases, to first order.
Preintegration with_biases_moved(Preintegration sum,
                                 const Eigen::Vector3d& by_gyro_rad_s,
                                 const Eigen::Vector3d& by_acc_m_s2);

/// Measurements between the frames of a window.
struct ImuIntervals {
  std::vector<Preintegration> between = {};  ///< one from each frame to the next
  std::string reason = "";                   ///< why there are none
};

/// Integrates rates without `bias_rad_s` and accelerations with their bias, both linear between
/// samples and constant for a sample beyond them. Frame times are on the camera's clock. Fails if
/// samples do not cover the window, leave a gap of more than five periods in it, or are not finite.
ImuIntervals imu_intervals(const Gyroscope& gyroscope,
                           std::span<const std::int64_t> frame_times_ns,
                           std::int64_t time_offset_ns,
                           const Eigen::Vector3d& bias_rad_s,
                           const ImuNoise& noise);

/// Noise density of the accelerations between two times on the sensor's clock [m/s^2/sqrt(Hz)], by
/// third differences of means over 10 ms, in which hands and drones hardly move. The vibration of a
/// drone is ten times the noise of a data sheet. nullopt for too few samples.
std::optional<double> accelerometer_noise_density(const Gyroscope& gyroscope,
                                                  std::int64_t first_ns,
                                                  std::int64_t last_ns);

/// State of a frame by inertial measurements, without the first velocity and gravity. World axes
/// are those of the first frame.
struct InertialFrame {
  double seconds = 0;                                  ///< since the first frame
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();     ///< sensor axes -> world axes
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  /// Derivatives of (theta, velocity, position) by the biases of gyroscope and accelerometer, with
  /// exp(theta) R.
  Eigen::Matrix<double, 9, 6> by_biases = Eigen::Matrix<double, 9, 6>::Zero();
  /// Covariance of (theta, velocity, position) by white noise.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
};

/// Chains intervals, one frame more than intervals. R_first: sensor axes at the first frame.
std::vector<InertialFrame> inertial_path(std::span<const Preintegration> between,
                                         const Eigen::Matrix3d& R_first);

/// Derivative of a later frame's (theta, velocity, position) by those of an earlier one.
Eigen::Matrix<double, 9, 9> moves(const InertialFrame& earlier, const InertialFrame& later);

/// Covariance of the positions of all frames but the first, stacked [m^2].
Eigen::MatrixXd position_covariance(std::span<const InertialFrame> path);

}  // namespace gpo
