// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/statistics.h"
#include "engine/window/window.h"

#include <chrono>
#include <compare>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

namespace gpo::bench {

inline constexpr int kUsualRepetitions = 15;
inline constexpr int kRepetitions = 3;    ///< of everything but the usual window
inline constexpr double kLeast_s = 0.02;  ///< duration of a repetition

/// Returns the processor time of this thread [ms], which other programs do not affect.
inline double thread_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Returns the elapsed time [ms], for work in several threads.
inline double wall_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

/// Sets the counter `ms` to the median duration of the work.
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

/// Registers `run(state)`.
template <class Run>
benchmark::internal::Benchmark* add(const std::string& name, const Run& run, double least_s = 0.1) {
  return benchmark::RegisterBenchmark(name.c_str(), run)
      ->MinTime(least_s)
      ->Repetitions(kRepetitions);
}

/// Size of a simulated window.
struct Size {
  int frames;
  int points;

  auto operator<=>(const Size&) const = default;
  int observations() const { return (frames - 1) * points; }
};

inline constexpr Size kUsual{30, 150};

std::vector<Size> sizes_over_frames();
std::vector<Size> sizes_over_points();
/// Returns sizes at which only `gpo` is measured.
std::vector<Size> large_sizes();

/// Returns the name of a benchmark: "gpo/30x150".
std::string name_of(const std::string& subject, const Size& size);

/// Windows with 0.5 px noise and fitted homographies, simulated when first requested.
class Windows {
 public:
  /// `biased`: with rotations from a gyroscope of unknown bias; else with true rotations.
  const Window& of(const Size& size, bool biased = false);

 private:
  std::map<std::pair<Size, bool>, Window> windows_;
};
using SharedWindows = std::shared_ptr<Windows>;

}  // namespace gpo::bench
