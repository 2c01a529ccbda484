// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/work/live_session.h"
#include "ui/workbench/work/worker.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

namespace gpo {

/// The program's functions for live sources.
struct LiveHooks {
  /// Returns the source of an address that the user typed or chose. Throws InputError. Null: none
  /// is opened.
  std::function<SourceAddress(const std::string& address)> source = {};
  LiveCameraOf camera_of = {};
  /// Makes a frozen source an open recording.
  std::function<Worker::Opened(std::shared_ptr<const Recording>)> opened = Worker::with_inspector;
  LiveClock clock = real_clock();
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

}  // namespace gpo
