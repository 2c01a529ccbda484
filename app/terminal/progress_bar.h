// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/report_timer.h"

#include <string>

namespace gpo {

/// Whether standard error is a terminal.
bool progress_is_watched();

/// One line on standard error that is overwritten as work goes on, and ended at the end; where
/// nobody watches, as in a log, a line every ten seconds.
class ProgressBar {
 public:
  explicit ProgressBar(std::string what) : title_(std::move(what)) {}
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// "WHAT [####....] DONE/OF frames", in a log without the bar.
  void show(int done, int of);

 private:
  std::string title_;
  ReportTimer report_timer_{ReportTimer::Clock::now()};
  bool begun_ = false;
};

}  // namespace gpo
