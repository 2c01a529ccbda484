// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <string>

namespace gpo::test {

/// Measures the peak memory of this process from here on.
class PeakMemory {
 public:
  PeakMemory() {
    std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak
    before_kib_ = status_kib("VmRSS:");
  }
  /// Returns the largest growth so far [KiB].
  long kib() const { return status_kib("VmHWM:") - before_kib_; }

 private:
  static long status_kib(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with(key)) return std::stol(line.substr(key.size()));
    return 0;
  }

  long before_kib_;
};

}  // namespace gpo::test
