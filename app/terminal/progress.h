// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/report_timer.h"

#include <csignal>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>

namespace gpo {

/// Thrown when the user stops the work. The message says what remains of it.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// While one exists, SIGINT and SIGTERM request a stop instead of ending the program. Create it
/// before other threads, which inherit the signal mask.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }
  /// Throws Interrupted if a stop was requested.
  void check(const std::string& remains) const;

 private:
  sigset_t signals_{};
  sigset_t mask_before_{};
  std::stop_source source_;
  std::jthread waiter_;  ///< last: it starts when all the others exist
};

/// Returns whether standard error is a terminal.
bool progress_is_watched();

/// One line on standard error, "TITLE [####....] DONE/OF frames", overwritten as work goes on. If
/// standard error is no terminal, prints a line without the bar every ten seconds.
class ProgressBar {
 public:
  explicit ProgressBar(std::string title) : title_(std::move(title)) {}
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void operator()(int done, int of);

 private:
  std::string title_;
  ReportTimer report_timer_{ReportTimer::Clock::now()};
  bool begun_ = false;
};

}  // namespace gpo
