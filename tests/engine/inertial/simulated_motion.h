// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// A sensor and a camera on an analytic path, and their measurements.
#pragma once

#include "engine/geometry/pose.h"
#include "engine/inertial/alignment_problem.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/window/gyroscope.h"

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Motion of the sensor in a world with z up: random sines.
struct SimulatedMotion {
  Eigen::Vector3d amplitude_m, speed_rad_s, phase;            ///< position, each axis
  Eigen::Vector3d swing_rad, swing_speed_rad_s, swing_phase;  ///< rotation vector
  Eigen::Matrix3d R_first;                                    ///< rotation where the swing is zero

  Eigen::Vector3d position(double t) const;
  Eigen::Vector3d velocity(double t) const;
  Eigen::Vector3d acceleration(double t) const;
  Eigen::Matrix3d rotation(double t) const;  ///< sensor's axes -> world's
  Eigen::Vector3d rate(double t) const;      ///< in the sensor's axes [rad/s]
};

enum class Pace { still, gentle, brisk };
struct SimulatedSensor {
  double gyroscope_density = 0, accelerometer_density = 0;
  double accelerometer_bias_sigma = 0.1, gyroscope_bias_sigma = 0.002;
  double scale_factor_sigma = 0, gravity_sigma = 0;
};
inline constexpr SimulatedSensor kPhone{.gyroscope_density = 3e-4, .accelerometer_density = 2e-3};
inline constexpr SimulatedSensor kEuroc{.gyroscope_density = 1.7e-4,
                                        .accelerometer_density = 2e-3,
                                        .accelerometer_bias_sigma = 0.1,
                                        .gyroscope_bias_sigma = 0.001};

/// Input of an alignment, and the truth.
struct SimulatedAlignment {
  UncertainPoses poses;
  Gyroscope gyroscope;
  Pose T_body_camera;
  InertialOptions options;
  Eigen::Vector3d gravity;  ///< in the first camera's axes [m/s^2]
  double scale = 0;
  std::vector<Eigen::Vector3d> velocities;  ///< sensor velocities, first camera's axes [m/s]
  Eigen::Vector3d accelerometer_bias;
  Eigen::VectorXd centers_and_bias;  ///< truth of the rows of the covariance
};

SimulatedMotion simulated_motion(Pace pace, unsigned seed);
/// 20 images and 200 samples a second. `noise` 0: exact measurements and poses with the covariances
/// of 1.
SimulatedAlignment simulated_alignment(
    Pace pace, const SimulatedSensor& sensor, double seconds, unsigned seed, double noise = 1);

/// The problem of the alignment with another bias of the gyroscope, and its true state.
AlignmentProblem simulated_problem(const SimulatedAlignment& made,
                                   const Eigen::Vector3d& gyro_bias,
                                   const ImuNoise& noise = {});
AlignmentState true_state(const SimulatedAlignment& made);

}  // namespace gpo
