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

/// A smooth path: start + velocity t + harmonics, for any time.
template <int N>
struct Path {
  using Vector = Eigen::Matrix<double, N, 1>;
  Vector start = Vector::Zero();
  Vector velocity = Vector::Zero();  ///< [1/s]
  std::vector<Harmonic<N>> harmonics;
};

/// Motion of the camera: its center, the point that it looks at, and its roll about that line.
struct Trajectory {
  Path<3> position;  ///< camera center [m]
  Path<3> look_at;   ///< [m]
  Path<1> roll;      ///< about the optical axis; positive turns the image counter-clockwise [rad]
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< up in an image without roll
};

/// Exact state of the camera; derivatives are analytic.
struct CameraMotion {
  Pose pose;                       ///< camera to world [m]
  Eigen::Vector3d velocity_w;      ///< camera center [m/s]
  Eigen::Vector3d acceleration_w;  ///< camera center [m/s^2]
  Eigen::Vector3d rate_c;          ///< angular rate in camera axes [rad/s]
};
CameraMotion camera_motion(const Trajectory& trajectory, double seconds);

/// State of the IMU, in body axes. Gravity is 9.81 m/s^2 against the world's z.
struct BodyMotion {
  Pose pose;                         ///< body to world [m]
  Eigen::Vector3d velocity_w;        ///< [m/s]
  Eigen::Vector3d rate_b;            ///< measurement of a perfect gyroscope [rad/s]
  Eigen::Vector3d specific_force_b;  ///< measurement of a perfect accelerometer [m/s^2]
};
BodyMotion body_motion(const Trajectory& trajectory, const Pose& T_body_camera, double seconds);

}  // namespace gpo
