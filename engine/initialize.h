// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/rotations.h"
#include "engine/geometry/camera.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/methods.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

/// The library's entry point: turns the tracks of any SLAM front end into a map's first cameras,
/// points and planes. All functions may be called from any thread; two calls, or two
/// `LiveInitializer`s, share no state, print no text and write no files. Bad input throws
/// InputError (engine/base/error.h), or SettingError for an option. A window that fails to
/// initialize is a result with a reason.
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
  /// Camera center from the IMU, in its axes [m]; nullopt: unknown, within some centimeters.
  std::optional<Eigen::Vector3d> p_gyro_camera_m = std::nullopt;
  MethodOptions method_options = {};

  bool operator==(const InitializeOptions&) const = default;
};

/// A window's result. World = its first camera; unit = the leading plane's distance from it.
struct WindowResult {
  /// `ok` or a reason; cameras, points, planes, uncertainty, verdict.
  Initialization initialization;
  std::vector<std::int64_t> ids;  ///< ids of the window's tracks, indexed by `MapPoint::track`
  RotationSource rotations = RotationSource::gyro;  ///< the source used, never automatic
  std::string rotations_note;                       ///< see `ChosenRotations::note`
  Window window;  ///< undistorted points, inliers, homographies, given rotations
  /// Gravity and metric scale; nullopt if the result is not ok or there are no accelerations.
  std::optional<InertialAlignment> inertial = std::nullopt;

  /// Returns whether the result is ok and the verdict on its window `ready`.
  bool is_ready() const;
  /// Returns whether the accelerometer determines the metric scale.
  bool is_metric() const;
};

/// Initializes from all frames of one window; bit-identical to `gpo-inspector run` for the same
/// tracks. Rotations are by default those of the frames, else from the gyroscope, else from the
/// images. Tracks are taken to have noise in frame 0, too; if theirs is exact, because templates of
/// frame 0 are aligned in all others, set `method_options.error` to `transfer`.
WindowResult initialize(const Camera& camera,
                        std::span<const Frame> frames,
                        const Gyroscope* gyroscope = nullptr,
                        const InitializeOptions& options = {},
                        const std::stop_token& stop = {});

struct LiveOptions {
  InitializeOptions initialize = {};
  bool background = true;     ///< windows are solved on a separate thread, not in `add_frame`
  int most_frames = 90;       ///< longest window that is not ready; then a new one starts [frames]
  int least_tracks = 20;      ///< still seen from the reference frame, else a new window starts
  double least_share = 0.25;  ///< the same as a share of them [-]
};

/// State after a frame.
struct LiveStatus {
  bool ready = false;
  bool metric = false;        ///< the answer has a metric scale: `answer->inertial`
  int reference = 0;          ///< first frame of the window, counted from the first frame added
  int frames = 0;             ///< length of the window
  int ready_frames = 0;       ///< length of the shortest window that is ready; 0: none
  int solved_frames = 0;      ///< length of the longest window solved so far; 0: none
  int pending = 0;            ///< windows waiting to be solved (`background`)
  bool started_anew = false;  ///< a new window starts with this frame, and drops a ready answer
  std::string reason;         ///< one line: why there is no answer, or no newer one
  /// Result of the longest window that was solved and agrees with the first one; null until ready.
  std::shared_ptr<const WindowResult> answer = nullptr;
};

/// A window that grows with each frame until it can be initialized. It is ready at the first length
/// at which `initialize` finds it so. Longer windows then improve the answer, but none rotates its
/// normal by more than four standard deviations of the first one. Windows that cannot be ready by
/// their homographies are not solved.
class LiveInitializer {
 public:
  /// `gyroscope` gives extrinsics and noise, with or without samples.
  explicit LiveInitializer(const Camera& camera,
                           const LiveOptions& options = {},
                           std::optional<Gyroscope> gyroscope = std::nullopt);
  ~LiveInitializer();
  LiveInitializer(LiveInitializer&&) noexcept;
  LiveInitializer& operator=(LiveInitializer&&) noexcept;

  /// Adds a sample, in order of time and if possible before the frame that it covers. Rates are in
  /// the gyroscope's own axes [rad/s].
  void add_gyroscope(std::int64_t timestamp_ns, const Eigen::Vector3d& rate_rad_s);
  /// The same with the specific force of an accelerometer in the same axes [m/s^2]; for all samples
  /// or for none.
  void add_imu(std::int64_t timestamp_ns,
               const Eigen::Vector3d& rate_rad_s,
               const Eigen::Vector3d& acceleration_m_s2);
  /// Adds a frame. Also rethrows errors of windows solved in the meantime (a gap in the gyroscope).
  LiveStatus add_frame(const Frame& frame);
  /// Returns the state after the last frame.
  LiveStatus status() const;
  /// Waits until no window is pending (`background`).
  LiveStatus wait();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gpo
