// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/inspection/live/live_window.h"
#include "ui/workbench/state.h"

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace gpo {

/// Returns the known camera of a device and the size of its images; nullopt if there is none.
using LiveCameraOf = std::function<std::optional<LiveCamera>(
    const SourceAddress& address, const std::string& device, cv::Size size)>;

struct LiveSessionOptions {
  LiveCameraOf camera_of = {};  ///< null: every camera is guessed
  CaptureOptions capture = {};
  LiveWindowOptions window = {};
};

/// Tracks and inspects a live source: capture, tracking and solving each on a thread of their own.
/// Images are dropped rather than late, and of the windows only the newest is solved. Thread-safe.
class LiveSession {
 public:
  /// `changed` is called on other threads when there is a new answer or state.
  LiveSession(SourceAddress address,
              const LiveSessionOptions& options,
              const std::function<void()>& changed = {});
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  /// Sets what the next windows are solved with.
  void want(const Settings& settings);
  /// Makes the next image a reference frame.
  void start_anew();
  LiveView view() const;
  /// Ends capture and tracking. Returns the last seconds; nullopt if there was no image.
  std::optional<LiveWindow::Frozen> freeze();

 private:
  void track(const std::stop_token& stop);
  void add(const LiveImage& image);
  BackgroundJob::Job next();

  const SourceAddress address_;
  const LiveCameraOf camera_of_;
  const std::function<void()> changed_;
  Capture capture_;
  std::mutex tracking_mutex_;  ///< guards the next two; taken before the lock of `job_`
  LiveWindow window_;
  cv::Size size_;                 ///< size of the last image [px]
  Settings settings_;             ///< this and the following with the lock of `job_`
  std::optional<LiveTask> task_;  ///< to be solved; nullopt: none
  bool anew_ = false;
  std::string error_;  ///< why tracking failed, one line
  LiveView view_;
  BackgroundJob job_;
  std::jthread tracker_;  ///< last, so that it ends first
};

/// Closes the open recording, whose settings are kept for the next time, and sets the window of the
/// one that is shown next.
void replace_recording(WorkbenchState& state, const FrameSpan& window);

/// Shows a live source: its window is the recording, and its newest image the current frame.
void show_live(WorkbenchState& state, const LiveView& view);

/// Returns what the source or its window lacks, or from which length on it is ready, one line.
std::string progress_text(const LiveView& view);
/// Returns size and number of the images and how many were dropped; empty before the first one.
std::string counts_text(const LiveView& view);

}  // namespace gpo
