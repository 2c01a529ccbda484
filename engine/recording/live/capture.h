// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/live/sources.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <stop_token>
#include <thread>

namespace gpo {

/// A live image as captured.
struct LiveImage {
  cv::Mat bgr;                    ///< CV_8UC3, read-only
  std::int64_t timestamp_ns = 0;  ///< later than that of the image before
  int segment = 0;                ///< grows whenever the size changes
  std::int64_t arrived_ns = 0;    ///< by the clock of `CaptureOptions`
};

enum class CaptureState { connecting, running, stalled, ended, failed };

struct CaptureStatus {
  CaptureState state = CaptureState::connecting;
  std::string message = {};  ///< one line: why it is in this state; empty while running
  std::string device = {};   ///< see `OpenSource`; empty until connected
  cv::Size size = {};        ///< size of the last image [px]; empty before the first
  int captured = 0;          ///< images, including the dropped ones
  int dropped = 0;           ///< images that were not taken in time, or were damaged
  int broken = 0;            ///< parts of the data that were skipped because they are damaged

  bool is_over() const { return state == CaptureState::ended || state == CaptureState::failed; }
};

struct CaptureOptions {
  int queue = 2;           ///< most images that wait to be taken; then the oldest is dropped
  double stall_s = 2;      ///< without an image for so long the source is `stalled` [s]
  double reconnect_s = 5;  ///< the same, until it is connected again [s]
  double give_up_s = 10;   ///< the same, until the capture ends [s]
  LiveClock clock = real_clock();
};

/// Reads a source on its own thread into a bounded queue. A stream that breaks off is connected
/// again every second; one that is refused before the first image fails at once. Thread-safe.
class Capture {
 public:
  /// `changed` is called on the capture's thread when the state changes, except to `running`: then
  /// there is an image.
  explicit Capture(const SourceAddress& address,
                   const CaptureOptions& options = {},
                   std::function<void()> changed = {});
  /// Interrupts the source and waits for the thread.
  ~Capture();
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  /// Waits for the next image; nullopt if stopped, or if the capture is over and all are taken.
  std::optional<LiveImage> take(const std::stop_token& stop);
  CaptureStatus status() const;

 private:
  void run(const std::stop_token& stop);
  /// Reads until the source ends. Returns why, one line.
  std::string read(const OpenSource& source, const std::stop_token& stop);
  void push(TimedImage image, int broken);
  void set_state(CaptureState state, const std::string& message);
  /// Notes how long there was no image. Returns whether to interrupt the source.
  bool is_overdue(const std::stop_token& stop);
  bool gives_up() const;
  double seconds_since(std::int64_t time_ns) const;

  const SourceAddress address_;
  const CaptureOptions options_;
  std::function<void()> changed_;
  std::int64_t connected_ns_ = 0;   ///< last attempt; used by the thread
  std::int64_t last_image_ns_ = 0;  ///< arrival of the last image, or start; used by the thread
  mutable std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<LiveImage> queue_;
  CaptureStatus status_;
  int segment_ = 0;
  std::jthread thread_;  ///< last, so that it ends first
};

}  // namespace gpo
