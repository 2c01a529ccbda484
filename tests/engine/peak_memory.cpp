// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/peak_memory.h"

#include <fstream>
#include <string>

namespace gpo::test {
namespace {

/// A number of /proc/self/status [KiB].
long status_kib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return std::stol(line.substr(key.size()));
  return 0;
}

}  // namespace

PeakMemory::PeakMemory() {
  std::ofstream("/proc/self/clear_refs") << "5";  // the kernel measures the peak anew
  held_before_kib_ = status_kib("VmRSS:");
}

long PeakMemory::kib() const { return status_kib("VmHWM:") - held_before_kib_; }

}  // namespace gpo::test
