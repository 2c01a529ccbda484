// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/initialize.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace gpo {

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
  bool metric = false;  ///< the answer has a metric scale: `answer->inertial`
  int reference = 0;    ///< first frame of the window, counted from the first frame added
  int frames = 0;       ///< length of the window
  /// Length of the shortest window that was solved and is ready; 0: none. `background` skips
  /// windows that are outdated before they can be solved; `wait` solves these, too.
  int ready_frames = 0;
  int solved_frames = 0;      ///< length of the longest window solved so far; 0: none
  int pending = 0;            ///< windows being solved or next in turn, at most two (`background`)
  int waiting = 0;            ///< frames that are not in the window yet; see `add_frame`
  bool started_anew = false;  ///< the last `add_frame` started a new window, at `reference`
  /// One line: why there is no answer, or no newer one; with `started_anew` why the window started.
  std::string reason = {};
  /// Result of the longest window that was solved and agrees with the first one; null until ready.
  std::shared_ptr<const WindowResult> answer = nullptr;
};

/// A window that grows with each frame until it can be initialized. It is ready at the first length
/// at which `initialize` finds it so. Longer windows then improve the answer, but none rotates its
/// normal by more than four standard deviations of the first one. Windows that cannot be ready by
/// their homographies are not solved. Memory is bounded.
class LiveInitializer {
 public:
  /// `gyroscope` gives extrinsics and noise, with or without samples.
  explicit LiveInitializer(const Camera& camera,
                           const LiveOptions& options = {},
                           const std::optional<Gyroscope>& gyroscope = std::nullopt);
  ~LiveInitializer();
  LiveInitializer(LiveInitializer&&) noexcept;
  LiveInitializer& operator=(LiveInitializer&&) noexcept;

  /// Adds a sample, in order of time. It may come after the frame that it covers, or at most ten
  /// minutes before. Rates are in the gyroscope's own axes [rad/s].
  void add_gyroscope(std::int64_t timestamp_ns, const Eigen::Vector3d& rate_rad_s);
  /// The same with the specific force of an accelerometer in the same axes [m/s^2]; for all samples
  /// or for none.
  void add_imu(std::int64_t timestamp_ns,
               const Eigen::Vector3d& rate_rad_s,
               const Eigen::Vector3d& acceleration_m_s2);
  /// Adds a frame. If there is a gyroscope, a frame waits until samples cover it, and joins the
  /// window with a later call; at most for half a second, or `most_frames`. A window that samples
  /// cover only in part ends, and a new one starts, with the `reason`; if it is ready, its answer
  /// is final, and later frames are ignored. Without any samples in the window the images determine
  /// the rotations (`rotations_note`). A frame that would start a new
  /// window also waits while the window before it is being solved. An error of the method is a
  /// `reason`, too. Throws InputError for a bad frame only.
  LiveStatus add_frame(const Frame& frame);
  /// Returns the current state.
  LiveStatus status() const;
  /// Moves the frames that samples cover into the window and solves all windows, also those that
  /// `background` skipped. Returns the same state as without `background`.
  LiveStatus wait();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gpo
