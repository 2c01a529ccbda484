// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Motion of the camera around the time of a frame, to second order: R_wc exp(t w + t^2 / 2 w'),
/// tau + t tau' + t^2 / 2 tau''.
struct Velocity {
  Eigen::Vector3d rotation_rad_s = Eigen::Vector3d::Zero();   ///< in the camera axes
  Eigen::Vector3d rotation_rad_s2 = Eigen::Vector3d::Zero();  ///< its derivative
  Eigen::Vector3d tau_s = Eigen::Vector3d::Zero();            ///< [plane distances / s]
  Eigen::Vector3d tau_s2 = Eigen::Vector3d::Zero();           ///< [plane distances / s^2]

  double rotation_sigma_rad_s = 0;  ///< standard deviations of the velocities, each axis
  double tau_sigma_s = 0;

  Eigen::Vector3d rotation_rad(double seconds) const {
    return seconds * rotation_rad_s + 0.5 * seconds * seconds * rotation_rad_s2;
  }
  Eigen::Vector3d tau(double seconds) const {
    return seconds * tau_s + 0.5 * seconds * seconds * tau_s2;
  }
};

/// Standard deviations of the poses of a path, independent between frames, each axis.
struct PathNoise {
  double rotation_rad = 0;
  double tau = 0;  ///< [plane distances]
};

/// Inputs of the smoothing of a path besides its values.
struct PathTimes {
  double duration_s = 0;
  Eigen::MatrixXd first = {}, second = {};  ///< map values to derivatives; empty: up to four times
  /// Variances of the first derivatives given exact values, if the third derivative is white noise
  /// of unit intensity.
  Eigen::VectorXd first_variance = {};
  Eigen::VectorXd roughness = {};  ///< eigenvalues of the penalty, ascending
  Eigen::MatrixXd vectors = {};    ///< its eigenvectors
};

PathTimes path_times(const Eigen::VectorXd& times_s);
PathTimes path_times(std::span<const std::int64_t> timestamps_ns);

/// Returns the velocities of a smooth path through noisy poses, one per frame. Differences of
/// neighboring poses would be so noisy that a row delay estimated with them is too small.
std::vector<Velocity> smooth_velocities(const PathTimes& times,
                                        const PlaneMotion& motion,
                                        const PathNoise& noise);

/// First and second derivatives of a path, one row per time.
struct Derivatives {
  Eigen::MatrixXd first;
  Eigen::MatrixXd second;
  Eigen::MatrixXd sigma;  ///< standard deviation of `first`
};

/// Returns the derivatives of a smooth path through each column of `values` (rows: times in
/// seconds, ascending), whose noise has the standard deviations `noise`: a smoothing spline of
/// degree 5. Its third derivative is white noise of an unknown intensity (Wahba 1978), the most
/// likely one for each column.
Derivatives smooth_derivatives(const PathTimes& times,
                               const Eigen::MatrixXd& values,
                               const Eigen::VectorXd& noise);

}  // namespace gpo
