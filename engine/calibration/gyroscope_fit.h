// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/rotations/gyroscope_alignment.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Placement of a gyroscope relative to its camera. Standard deviations are clustered by window, as
/// all frames of a window share errors.
struct GyroscopeFit {
  bool ok = false;
  std::string reason;                                            ///< why it is not
  Eigen::Matrix3d R_gyro_camera = Eigen::Matrix3d::Identity();   ///< camera axes -> gyroscope axes
  Eigen::Vector3d rotation_sigma_deg = Eigen::Vector3d::Zero();  ///< about the camera's axes
  /// Gyroscope clock = camera clock + offset, in the middle of the recording.
  double time_offset_s = 0;
  double time_offset_sigma_s = 0;
  std::optional<double> drift;  ///< change of the offset [s/s]; nullopt below a minute
  double drift_sigma = 0;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();  ///< gyroscope axes
  Eigen::Vector3d bias_sigma_rad_s = Eigen::Vector3d::Zero();
  bool differs = false;    ///< the gyroscope rotates, but not as the images do
  double correlation = 0;  ///< between the magnitudes of the rates of gyroscope and images, -1 to 1
  double rms_before_deg = 0;  ///< rotations from a window's first frame, before the fit
  double rms_deg = 0;         ///< the same after the fit
  int windows = 0;            ///< used
  int outliers = 0;           ///< windows left out, as their images disagree
  std::vector<std::string> warnings;
};

/// Estimates the rotation between gyroscope and camera, the offset of the clocks (within a second
/// of the recording's), drift and bias. Starts on a grid of offsets, each with the rotation between
/// the rates of gyroscope and images (Wahba's problem, for any naming of the axes), and then
/// minimizes a robust loss over the rotations of all windows. Warns if mirrored axes would fit far
/// better.
GyroscopeFit fit_gyroscope(const std::vector<ImageRotations>& windows, const Gyroscope& gyroscope);

/// Adds the error of the calibration to the standard deviations of the rotation: a wrong principal
/// point turns the camera's axes. Without standard deviations it is a typical one
/// (`kTypicalLensShare`).
void add_lens_error(GyroscopeFit& fit, const Camera& camera);

}  // namespace gpo
