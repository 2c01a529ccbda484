// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// Uncertainty of a pose computed from the image of a board: standard deviations (roots of the
/// covariances' traces) from the noise in the residuals of the fit. Errors of the calibration and
/// of the board's size or flatness are not included.
struct PoseUncertainty {
  double rms_px = 0;              ///< reprojection error of the board's corners
  double position_sigma_m = 0;    ///< camera in the board frame
  double rotation_sigma_deg = 0;  ///< camera
  double normal_sigma_deg = 0;    ///< board normal in the camera frame
};

/// A change between two successive poses that no camera makes, from a wrong pose.
struct TruthJump {
  std::int64_t first_ns = 0, last_ns = 0;  ///< times of the poses, camera clock
  double angle_deg = 0;
  double step_m = 0;
};

/// True camera poses, one per frame; nullopt if a frame has none.
struct GroundTruth {
  std::string source;                                           ///< file name, for people
  std::vector<std::optional<Pose>> poses;                       ///< in the truth's world [m]
  std::vector<std::optional<PoseUncertainty>> uncertainties{};  ///< one per pose; empty if unknown
  bool upright = false;            ///< the world's z axis points away from gravity
  std::vector<TruthJump> jumps{};  ///< between the samples of the file, while there are frames
  int left_out = 0;                ///< rows of the file that are not finite or repeat a time
  std::optional<Readout> estimated_readout{};  ///< set if the poses of a board depend on it
  /// Rotation of the file's extrinsics, which the poses include: x_measured = R x_camera.
  Eigen::Matrix3d R_measured_camera = Eigen::Matrix3d::Identity();
};

/// The truth of one window, in the truth's own world.
struct WindowTruth {
  std::string source;
  std::vector<std::optional<Pose>> cameras;  ///< one per frame of the window [m]
  std::optional<Plane> plane;                ///< [m]
  std::vector<std::optional<PoseUncertainty>>
      uncertainties{};                         ///< one per camera; empty if unknown
  bool upright = false;                        ///< the world's z axis points away from gravity
  std::optional<Readout> estimated_readout{};  ///< see `GroundTruth`
  Eigen::Matrix3d R_measured_camera = Eigen::Matrix3d::Identity();  ///< see `GroundTruth`
};

}  // namespace gpo
