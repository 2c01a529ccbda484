// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/statistics.h"
#include "engine/window/window.h"

#include <chrono>
#include <compare>
#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

namespace gpo::bench {

inline constexpr int kUsualRepetitions = 15;
inline constexpr int kRepetitions = 3;    ///< for everything but the usual window
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
  int frames, points;

  auto operator<=>(const Size&) const = default;
  int observations() const { return (frames - 1) * points; }
};

inline constexpr Size kUsual{30, 150};

/// Returns a window with 0.5 px noise and fitted homographies, simulated when first requested.
/// `biased`: with rotations from a gyroscope of unknown bias; else with true rotations.
const Window& window_of(const Size& size, bool biased = false);

/// Collects the results for the tables; Google Benchmark's own lines go to stderr.
class Results : public benchmark::ConsoleReporter {
 public:
  Results();
  void ReportRuns(const std::vector<Run>& runs) override;

  /// Returns the minimum of a benchmark's counter over the repetitions; nullopt if it did not run.
  std::optional<double> least(const std::string& benchmark, const std::string& counter) const;
  std::optional<double> ms(const std::string& benchmark) const { return least(benchmark, "ms"); }

 private:
  std::map<std::pair<std::string, std::string>, double> least_;  ///< by benchmark and counter
};

/// Returns a / b; nullopt if one of them is missing.
std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b);

/// Returns three significant digits without exponent, e.g. "0.0123", "4.56", "1230"; "-" for a
/// missing value or zero.
std::string cell(const std::optional<double>& value);
/// Returns the same without decimals.
std::string whole_number(const std::optional<double>& value);

/// Prints a line of a Markdown table.
void print_row(const std::vector<std::string>& cells);
/// Prints its first two lines, of titles separated by " | ": the first column is left-aligned, the
/// others are right-aligned.
void print_head(const std::string& titles);

// Each file of benchmarks registers its own, and prints their tables of the README.

/// All methods on simulated windows, the parts of GPO and growing windows, in one thread.
void register_method_benchmarks();
void print_method_tables(const Results& results);

/// Front end, planes, gravity, live initialization and `evaluate`.
void register_stage_benchmarks();
void print_stage_tables(const Results& results);

/// Views off-screen at 1280x720.
void register_view_benchmarks();
void print_view_tables(const Results& results);

}  // namespace gpo::bench
