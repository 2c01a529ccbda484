// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace gpo {

/// Says when another line of progress is due, where each stays to be read.
class ReportTimer {
 public:
  using Clock = std::chrono::steady_clock;

  /// The first is due a period after `begin`.
  explicit ReportTimer(Clock::time_point begin, Clock::duration period = std::chrono::seconds(10))
      : last_(begin), period_(period) {}

  /// Whether a period has passed since it last was.
  bool due(Clock::time_point now) {
    if (now - last_ < period_) return false;
    last_ = now;
    return true;
  }

 private:
  Clock::time_point last_;
  Clock::duration period_;
};

}  // namespace gpo
