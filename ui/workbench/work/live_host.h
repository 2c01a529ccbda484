// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/live/live_window.h"
#include "ui/workbench/work/worker.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace gpo {

/// Returns the known camera of a device and the size of its images; nullopt if there is none.
using LiveCameraOf = std::function<std::optional<LiveCamera>(
    const SourceAddress& address, const std::string& device, cv::Size size)>;

/// The program's functions for live sources.
struct LiveHooks {
  /// Returns the source of an address that the user typed or chose. Throws InputError. Null: none
  /// is opened.
  std::function<SourceAddress(const std::string& address)> source = {};
  LiveCameraOf camera_of = {};  ///< null: every camera is guessed
  /// Makes a frozen source an open recording.
  std::function<Worker::Opened(std::shared_ptr<const Recording>)> opened = Worker::with_inspector;
  LiveClock clock = real_clock();
};

/// Tracks and inspects a live source: capture, tracking and solving each on a thread of their own.
/// Images are dropped rather than late, and of the windows only the newest is solved. Thread-safe.
class LiveSession {
 public:
  /// Keeps the last `seconds`. `changed` is called on other threads when there is a new answer or
  /// state.
  LiveSession(SourceAddress address,
              const LiveHooks& hooks,
              double seconds,
              const std::function<void()>& changed);

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

/// The live source of a window: opens it on request, shows it, and freezes it as a recording.
class LiveHost {
 public:
  /// `changed`: see `LiveSession`.
  explicit LiveHost(std::function<void()> changed) : changed_(std::move(changed)) {}

  LiveHooks hooks;

  /// Fulfills requests and shows the open source. Returns whether it is shown, or frozen and not
  /// published yet, so that the worker's recording must not be.
  bool synchronize(WorkbenchState& state, WorkerLink& link, Worker& worker);
  /// Measures the delay of the image that the window shows now.
  void note_shown(const WorkbenchState& state);

 private:
  void open(WorkbenchState& state, WorkerLink& link, Worker& worker, const std::string& address);
  void freeze(WorkbenchState& state, WorkerLink& link, Worker& worker);
  /// Returns whether the worker has not published the frozen recording yet. Once it has, makes room
  /// for it.
  bool waits_for_frozen(WorkbenchState& state, const Worker& worker);
  void report_frozen(WorkbenchState& state);

  std::function<void()> changed_;
  std::unique_ptr<LiveSession> session_;     ///< null: none is open
  std::string address_;                      ///< address of that session
  std::shared_ptr<const Recording> frozen_;  ///< not published by the worker yet; null: none
  FrameSpan window_;                         ///< in the frozen recording
  /// The same until it is shown, and why its source ended; empty: the user froze it.
  std::shared_ptr<const Recording> reported_;
  CaptureStatus end_;
  std::int64_t noted_ns_ = 0;    ///< arrival of the last image in `delays_s_`
  std::deque<double> delays_s_;  ///< delays of up to 61 images
};

/// Shows a live source: its window is the recording, and its newest image the current frame.
void show_live(WorkbenchState& state, const LiveView& view);

/// Returns what the source or its window lacks, or from which length on it is ready, one line.
std::string progress_text(const LiveView& view);
/// Returns size and number of the images and how many were dropped; empty before the first one.
std::string counts_text(const LiveView& view);

}  // namespace gpo
