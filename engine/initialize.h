// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/eigen_layout.h"
#include "engine/base/error.h"
#include "engine/geometry/camera.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/methods.h"
#include "engine/result.h"
#include "engine/rotations/rotations.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

/// The library's entry point: turns the tracks of any SLAM front end into a map's first cameras,
/// points and planes. All functions may be called from any thread, those of one `LiveInitializer`
/// at the same time, too; two calls, or two `LiveInitializer`s, share no state, print no text and
/// write no files. Bad input throws InputError, or SettingError for an option, and a call that
/// throws changes nothing. A window that fails to initialize is a result with a reason.
namespace gpo {

/// Tracks of one frame. Frame 0 of a window is its reference: the window uses the tracks seen in
/// it.
struct Frame {
  std::int64_t timestamp_ns = 0;       ///< later than that of the frame before
  std::vector<std::int64_t> ids = {};  ///< tracks that are seen, all different
  Eigen::Matrix2Xd raw_px = {};        ///< their places, 2 x ids, in the distorted image [px]
  /// Rotation from the camera to any fixed world, if known; of all frames or of none.
  std::optional<Eigen::Matrix3d> R_wc = std::nullopt;
  /// Standard deviation of each observation, both coordinates [px], of all frames or of none. Only
  /// their ratios count, as weights: the noise is estimated from the residuals.
  Eigen::VectorXd sigma_px = {};
};

/// The options of `gpo-inspector run`, under the same names.
struct InitializeOptions {
  MethodChoice method = "gpo_joint";  ///< one of `methods()` by its key, or a row of your own
  RotationSource rotations = RotationSource::automatic;  ///< `truth`: those of the frames
  std::optional<bool> ransac = std::nullopt;  ///< off: all tracks; nullopt: the method's default
  /// Largest transfer error of an inlier [px]; nullopt: `RansacOptions::threshold_px`.
  std::optional<double> ransac_threshold_px = std::nullopt;
  std::optional<Inliers> inliers =
      std::nullopt;  ///< their selection; nullopt: the method's default
  /// The leading plane, counted from 1 by support; a window with fewer planes fails [-].
  int plane = 1;
  std::uint64_t seed = 1;        ///< for every random choice [-]
  bool camera_is_guess = false;  ///< the camera is uncalibrated: windows are at most `weak`
  /// The verdict's assumption where `Camera` states no uncertainty.
  Lens lens = Lens::typical;
  Gravity gravity = Gravity::after;  ///< gravity and metric scale, if there are accelerations
  /// Standard deviation of the accelerometer's bias, each axis, above 0 [m/s^2].
  double accelerometer_bias_sigma_m_s2 = kAccelerometerBiasSigma_m_s2;
  /// Camera center from the IMU, in its axes [m]; nullopt: unknown, within some centimeters.
  std::optional<Eigen::Vector3d> p_gyro_camera_m = std::nullopt;
  /// Keys of findings that do not lower the verdict (`checks()`).
  std::vector<std::string> ignore_findings = {};
  MethodOptions method_options = {};

  bool operator==(const InitializeOptions&) const = default;
};

/// Initializes from all frames of one window; bit-identical to `gpo-inspector run` for the same
/// tracks. Rotations are by default those of the frames, else from the gyroscope if its samples
/// cover the window and fit the images, else from the images (`WindowResult::rotations_note`).
/// Tracks are taken to have noise in frame 0, too; if theirs is exact, because templates of frame 0
/// are aligned in all others, set `method_options.error` to `transfer`.
WindowResult initialize(const Camera& camera,
                        std::span<const Frame> frames,
                        const Gyroscope* gyroscope = nullptr,
                        const InitializeOptions& options = {},
                        const std::stop_token& stop = {});

}  // namespace gpo
