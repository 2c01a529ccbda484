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

/// The front door: from what every SLAM front end has to a map's first cameras, points and planes.
/// Everything here may be called from any thread; two calls, or two `LiveInitializer`s, share
/// nothing. Nothing is printed, nothing written. Bad input throws InputError (engine/base/error.h),
/// and SettingError where it is an option's; what merely fails to initialize is a value that says
/// why.
namespace gpo {

/// What a front end knows of a frame. Frame 0 of a window is its reference: a window uses the
/// tracks that are seen in it.
struct Frame {
  std::int64_t timestamp_ns = 0;       ///< later than that of the frame before
  std::vector<std::int64_t> ids = {};  ///< of the tracks that are seen, no two alike
  Eigen::Matrix2Xd raw_px = {};        ///< where, 2 x ids, in the picture as it is [px]
  /// Camera to any world that does not turn, where rotations are known; of all frames or of none.
  std::optional<Eigen::Matrix3d> R_wc = std::nullopt;
};

/// As `gpo-inspector run` has them, under the names of its options.
struct InitializeOptions {
  MethodChoice method = "gpo_joint";  ///< one of `methods()` by its key, or a row of your own
  RotationSource rotations = RotationSource::automatic;  ///< `truth`: those of the frames
  std::optional<bool> ransac = std::nullopt;  ///< off: all tracks; nothing: as the method does
  double ransac_threshold_px = 2.0;           ///< largest transfer error of an inlier [px]
  std::optional<Inliers> inliers =
      std::nullopt;        ///< how they are told; nothing: as the method does
  int plane = 1;           ///< which of the window's planes leads, counted by their support [-]
  std::uint64_t seed = 1;  ///< of every random choice [-]
  bool camera_is_guess = false;      ///< nobody calibrated it: no window is more than `weak` then
  Gravity gravity = Gravity::after;  ///< gravity and meters, where there are accelerations
  /// Camera center from the IMU, in its axes [m]; nothing: unknown, by some centimeters.
  std::optional<Eigen::Vector3d> p_gyro_camera_m = std::nullopt;
  MethodOptions method_options = {};

  bool operator==(const InitializeOptions&) const = default;
};

/// A window's result. World = its first camera; unit = the leading plane's distance from it.
struct WindowResult {
  Initialization
      initialization;  ///< `ok` or a reason; cameras, points, planes, uncertainty, verdict
  std::vector<std::int64_t> ids;  ///< of the window's tracks: what `MapPoint::track` counts
  RotationSource rotations = RotationSource::gyro;  ///< that were used, never automatic
  std::string rotations_note;  ///< why not what `automatic` tries first, or what told them
  Window window;               ///< undistorted points, inliers, homographies, given rotations
  /// Gravity and meters of a result that is ok, where the gyroscope comes with accelerations.
  std::optional<InertialAlignment> inertial = std::nullopt;

  /// The result is ok, and the verdict on its window `ready`.
  bool is_ready() const;
  /// The accelerometer tells how many meters a unit is.
  bool is_metric() const;
};

/// One window, all frames of it; the same bits as `gpo-inspector run` for the same tracks.
/// `automatic` takes the frames' rotations where they have any, else the gyroscope's, else the
/// pictures'.
WindowResult initialize(const Camera& camera,
                        std::span<const Frame> frames,
                        const Gyroscope* gyroscope = nullptr,
                        const InitializeOptions& options = {},
                        const std::stop_token& stop = {});

struct LiveOptions {
  InitializeOptions initialize = {};
  bool background = true;  ///< windows are solved on a thread of its own, not in `add_frame`
  int most_frames = 90;    ///< of a window that is not ready; the next frame starts anew [frames]
  int least_tracks = 20;   ///< of the reference frame's that are still seen, else anew [tracks]
  double least_share = 0.25;  ///< of them, likewise [-]
};

/// What is known after a frame.
struct LiveStatus {
  bool ready = false;
  bool metric = false;   ///< the answer is in known meters, too: `answer->inertial`
  int reference = 0;     ///< the frame at which the window starts, counted from the first one added
  int frames = 0;        ///< of the window
  int ready_frames = 0;  ///< length of the shortest window that is ready; 0: none is
  int solved_frames = 0;      ///< of the longest window that was solved so far; 0: none
  int pending = 0;            ///< windows that wait to be solved (`background`)
  bool started_anew = false;  ///< with this frame, by which a ready answer is given up, too
  std::string reason;         ///< one line: why there is no answer, or why not a newer one
  /// The answer of the longest window that was solved and agrees with the first one; null: none.
  std::shared_ptr<const WindowResult> answer = nullptr;
};

/// A window that grows with each frame until it is fit to initialize from. It is ready at the first
/// length at which `initialize` finds it so; afterwards longer windows make the answer better, and
/// none moves its normal by more than four standard deviations of the first one. What cannot be
/// ready is told by homographies alone and not solved.
class LiveInitializer {
 public:
  /// `gyroscope`: how it sits and how noisy it is, with or without samples.
  explicit LiveInitializer(const Camera& camera,
                           const LiveOptions& options = {},
                           std::optional<Gyroscope> gyroscope = std::nullopt);
  ~LiveInitializer();
  LiveInitializer(LiveInitializer&&) noexcept;
  LiveInitializer& operator=(LiveInitializer&&) noexcept;

  /// In order of time; before the frame that they belong to, as far as they are there. Rates in the
  /// gyroscope's own axes [rad/s].
  void add_gyroscope(std::int64_t timestamp_ns, const Eigen::Vector3d& rate_rad_s);
  /// The same with the specific force of an accelerometer, in the same axes [m/s^2]: all samples
  /// have one, or none.
  void add_imu(std::int64_t timestamp_ns,
               const Eigen::Vector3d& rate_rad_s,
               const Eigen::Vector3d& acceleration_m_s2);
  /// Throws also what solving a window threw since (a gyroscope with a gap).
  LiveStatus add_frame(const Frame& frame);
  /// Of the frame that was added last.
  LiveStatus status() const;
  /// Waits until no window is pending (`background`).
  LiveStatus wait();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gpo
