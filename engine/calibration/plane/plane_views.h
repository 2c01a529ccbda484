// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// What one picture shows of a plane: which of its points, and where.
struct PlaneView {
  int frame = 0;            ///< counts in the recording
  std::vector<int> points;  ///< numbers of the plane's points, ascending
  Eigen::Matrix2Xd raw_px;  ///< one column each
  /// How far each one goes from frame to frame [px], one column each; 0 where nobody knows.
  Eigen::Matrix2Xd flow_px = Eigen::Matrix2Xd::Zero(2, raw_px.cols());
};

/// A plane whose points are at unknown places on it, and all pictures that show some of them.
struct ObservedPlane {
  int points = 0;
  std::vector<PlaneView> views;  ///< in the order of time
};

/// How a gyroscope says the camera turned between two frames, R_ab of the camera's axes, and how
/// that moves where the bias is larger by db than the one it was integrated with: R_ab exp(d_bias
/// db), first order.
struct GyroRotation {
  int from = 0;  ///< frame
  int to = 0;    ///< frame
  Eigen::Matrix3d R_from_to = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d d_bias = Eigen::Matrix3d::Zero();  ///< [s]
  double sigma_rad = 1e-3;
};

/// The turns between frames, and how well the bias is known.
struct GyroRotations {
  std::vector<GyroRotation> rotations;    ///< empty: there is no gyroscope
  double bias_sigma_rad_s = 0.1;  ///< of db, each axis
};

}  // namespace gpo
