// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/statistics.h"

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace gpo::bench {

/// Processor time of this thread [ms]: what other programs do meanwhile does not count.
inline double thread_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Time that passes [ms], for what works in several threads.
inline double wall_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

/// The counter `ms` becomes the median over the iterations of what the work takes.
template <class Work>
void measure(benchmark::State& state, double (*clock_ms)(), const Work& work) {
  std::vector<double> ms;
  while (state.KeepRunning()) {
    const double begin = clock_ms();
    work();
    ms.push_back(clock_ms() - begin);
  }
  if (!ms.empty()) state.counters["ms"] = median(std::move(ms));
}

}  // namespace gpo::bench
