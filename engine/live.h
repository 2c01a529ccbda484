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
