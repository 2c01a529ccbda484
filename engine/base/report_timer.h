// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace gpo {

/// Limits the rate of progress lines.
class ReportTimer {
 public:
  using Clock = std::chrono::steady_clock;

  /// The first line is due a period after `begin`.
  explicit ReportTimer(Clock::time_point begin, Clock::duration period = std::chrono::seconds(10))
      : last_(begin), period_(period) {}

  /// Returns whether a period has passed since the last line.
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
