// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inertial/preintegration.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Where inertial measurements alone put a frame, in the world's axes (first frame), without the
/// first velocity and gravity.
struct InertialFrame {
  double seconds = 0;                                  ///< since the first frame
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();     ///< sensor's axes -> world's
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  /// By the gyroscope's bias and the accelerometer's; the rotation's is theta of exp(theta) R.
  Eigen::Matrix<double, 9, 6> by_biases = Eigen::Matrix<double, 9, 6>::Zero();
  /// Of (theta, velocity, position): white noise.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
};

/// One a frame: the intervals one after the other, the sensor's axes at the first frame R_first.
std::vector<InertialFrame> inertial_path(std::span<const Preintegration> between,
                                         const Eigen::Matrix3d& R_first);

/// How errors of an earlier frame, over (theta, velocity, position), move a later one.
Eigen::Matrix<double, 9, 9> moves(const InertialFrame& earlier, const InertialFrame& later);

/// Covariance of the positions of all frames but the first, stacked [m^2].
Eigen::MatrixXd position_covariance(std::span<const InertialFrame> path);

}  // namespace gpo
