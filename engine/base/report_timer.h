// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace gpo {

/// Limits progress lines to one in ten seconds.
class ReportTimer {
 public:
  using Clock = std::chrono::steady_clock;

  /// The first line is due ten seconds after `begin`.
  explicit ReportTimer(Clock::time_point begin) : last_(begin) {}

  bool due(Clock::time_point now) {
    if (now - last_ < std::chrono::seconds(10)) return false;
    last_ = now;
    return true;
  }

 private:
  Clock::time_point last_;
};

}  // namespace gpo
