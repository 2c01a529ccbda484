// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// How a gyroscope sits on its camera, or the reason why nothing tells. Standard deviations are
/// clustered by window: what a window has wrong, all its frames have.
struct GyroscopeFit {
  bool ok = false;
  std::string reason;                                            ///< why not
  Eigen::Matrix3d R_gyro_camera = Eigen::Matrix3d::Identity();   ///< camera axes -> gyroscope axes
  Eigen::Vector3d rotation_sigma_deg = Eigen::Vector3d::Zero();  ///< about the camera's axes
  double time_offset_s = 0;  ///< gyroscope clock = camera clock + offset, in the recording's middle
  double time_offset_sigma_s = 0;
  /// Change of the offset [s/s]; nothing where the recording is shorter than a minute.
  std::optional<double> drift;
  double drift_sigma = 0;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();  ///< gyroscope's axes
  Eigen::Vector3d bias_sigma_rad_s = Eigen::Vector3d::Zero();
  double correlation = 0;     ///< of the speeds of rotation, gyroscope against pictures, -1 to 1
  double rms_before_deg = 0;  ///< of a window's frames against its first, as the recording has it
  double rms_deg = 0;         ///< the same, fitted
  int windows = 0;            ///< used
  int outliers = 0;           ///< windows whose pictures disagree
  std::vector<std::string> warnings;
};

/// Rotation between gyroscope and camera, offset of the clocks (within a second of what the
/// recording says), drift and bias: first every offset on a grid, each with the rotation that best
/// turns the gyroscope's rates into the pictures' (Wahba's problem; any of the 24 ways in which
/// axes may be named, too), then all together by robust least squares over the windows' rotations.
/// No rotation is tried that mirrors; axes that would fit far better mirrored are told.
GyroscopeFit fit_gyroscope(const std::vector<ImageRotations>& windows,
                           const Gyroscope& gyroscope);

/// Angular rates over time, camera axes, at the middles between a window's frames.
struct RatesOverTime {
  std::vector<double> time_s;  ///< from the first one on, camera clock
  std::vector<Eigen::Vector3d> images_rad_s;
  std::vector<Eigen::Vector3d> before_rad_s;  ///< the gyroscope's, as the recording has it
  std::vector<Eigen::Vector3d> after_rad_s;   ///< fitted
};

RatesOverTime rates_over_time(const std::vector<ImageRotations>& windows,
                              const Gyroscope& gyroscope,
                              const GyroscopeFit& fit);

}  // namespace gpo
