// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/recording/live/live_recording.h"
#include "engine/tracking/tracker.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace gpo {

struct LiveWindowOptions {
  int most_frames = 60;       ///< longest window; then every second frame is dropped
  int least_tracks = 20;      ///< still seen from the reference frame, else a new window starts
  double least_share = 0.25;  ///< the same as a share of them [-]
  double seconds = 20;        ///< that the buffer keeps [s]
  std::size_t most_bytes = std::size_t{512} << 20;  ///< memory of the buffer
};

/// The window at one time, to be inspected on another thread.
struct LiveTask {
  std::shared_ptr<const Recording> recording;  ///< the window's frames so far
  std::shared_ptr<const Tracks> tracks;        ///< in all of them
  std::int64_t arrived_ns = 0;                 ///< arrival of the last frame (`LiveImage`)
  int window = 0;                              ///< counts the windows of a source
  int halvings = 0;                            ///< how often every second frame was left out
  int solved = 0;        ///< frames of the longest window that was inspected before
  int ready_frames = 0;  ///< frames of the shortest one that was ready; 0: none
};

/// A live window as the views show it. Immutable.
struct LiveAnswer {
  LiveTask task;                                           ///< with this answer
  std::shared_ptr<const Inspection> inspection = nullptr;  ///< null with one frame
  std::string missing = {};  ///< one line: what it lacks to be ready; empty if it is
};

/// A live source as it is shown.
struct LiveView {
  std::string address;  ///< see `SourceAddress`
  CaptureStatus capture = {};
  std::shared_ptr<const LiveAnswer> answer = nullptr;  ///< the latest; null before the first image
  std::string why_anew = {};                           ///< why its window started, one line
  /// Time from an image's arrival until it was shown with its answer, median of the last; nullopt
  /// before the first.
  std::optional<double> delay_s = std::nullopt;
};

/// Tracks live images from a reference frame on, with the tracker of recordings, in a window that
/// grows with each image, and keeps the last seconds. A new window starts when tracks are lost or
/// the image's size changes. Memory is bounded. Not thread-safe. Throws InputError.
class LiveWindow {
 public:
  explicit LiveWindow(LiveOrigin origin, const LiveWindowOptions& options = {});

  /// Adds an image, CV_8UC3. Returns whether it is the reference frame of a new window.
  bool add(const LiveImage& image, Tracking tracking);
  /// Makes the next image a reference frame.
  void start_anew() { tracker_.reset(); }
  void set_origin(LiveOrigin origin) { origin_ = std::move(origin); }

  int frames() const { return static_cast<int>(images_.size()); }
  const std::string& why_anew() const { return why_anew_; }
  /// Takes over what was found about an earlier state of the same window.
  void note(const LiveTask& noted);
  /// Returns what to inspect now. There is at least one frame.
  LiveTask task() const;
  /// Returns the last seconds as a recording, preceded by older frames of the window, and the
  /// window in it. There is at least one frame.
  struct Frozen {
    std::shared_ptr<const Recording> recording;
    FrameSpan window;
  };
  Frozen frozen() const;

 private:
  std::string why_restart(const LiveImage& image, Tracking tracking) const;
  void drop_every_second();

  LiveOrigin origin_;
  const LiveWindowOptions options_;
  LiveBuffer buffer_;
  std::optional<WindowTracker> tracker_;
  Tracking tracking_ = Tracking::anchored;
  std::vector<LiveImage> images_;  ///< frames of the window
  LiveTask found_;                 ///< without recording and tracks
  std::string why_anew_;
};

/// Inspects a window, or none if it has only one frame. If it is ready, also finds the shortest
/// length that is, among those not inspected before. The window in `settings` is ignored. Returns
/// nullopt if stopped. Throws InputError.
std::optional<LiveAnswer> inspect(LiveTask task,
                                  const Settings& settings,
                                  const std::stop_token& stop = {});

/// Returns what a window lacks to be ready, one line for people; empty if it is.
std::string missing_for_ready(const Inspection& inspection);

}  // namespace gpo
