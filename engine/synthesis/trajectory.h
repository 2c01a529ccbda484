// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// amplitude * sin(2 pi frequency t + phase).
template <int N>
struct Harmonic {
  Eigen::Matrix<double, N, 1> amplitude;
  double frequency = 0;  ///< [Hz]
  double phase = 0;      ///< [rad]
};

/// A smooth path: start + velocity t + its harmonics; defined before 0 and after the end, too.
template <int N>
struct Path {
  using Vector = Eigen::Matrix<double, N, 1>;
  Vector start = Vector::Zero();
  Vector velocity = Vector::Zero();  ///< [1/s]
  std::vector<Harmonic<N>> harmonics;
};

/// How the camera moves: where it is, the point that it looks at, and its roll about that line.
struct Trajectory {
  Path<3> position;  ///< of the camera center [m]
  Path<3> look_at;   ///< [m]
  Path<1> roll;  ///< about the optical axis, counter-clockwise picture for positive values [rad]
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< is up in a picture without roll
};

/// Exact state of the camera; derivatives are analytic.
struct CameraMotion {
  Pose pose;                       ///< camera to world [m]
  Eigen::Vector3d velocity_w;      ///< of the camera center [m/s]
  Eigen::Vector3d acceleration_w;  ///< of the camera center [m/s^2]
  Eigen::Vector3d rate_c;          ///< angular rate in camera axes [rad/s]
};
CameraMotion camera_motion(const Trajectory& trajectory, double seconds);

/// State of the IMU, whose axes are the body's. Gravity is 9.81 m/s^2 against the world's z.
struct BodyMotion {
  Pose pose;                         ///< body to world [m]
  Eigen::Vector3d velocity_w;        ///< [m/s]
  Eigen::Vector3d rate_b;            ///< what a perfect gyroscope reads [rad/s]
  Eigen::Vector3d specific_force_b;  ///< what a perfect accelerometer reads [m/s^2]
};
BodyMotion body_motion(const Trajectory& trajectory, const Pose& T_body_camera, double seconds);

}  // namespace gpo
