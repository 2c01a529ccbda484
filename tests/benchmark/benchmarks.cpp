// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/benchmarks.h"

#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core/utility.hpp>

namespace gpo::bench {

const Window& window_of(const Size& size, bool biased) {
  static std::map<std::pair<Size, bool>, Window> windows;
  const auto [window, first] = windows.try_emplace({size, biased});
  if (first) {
    test::SimulationOptions options;
    options.frames = size.frames;
    options.points = size.points;
    if (biased) options.gyro_bias_rad_s = options.gyro_noise_rad_s = 0.002;
    window->second = test::simulate_fitted(options).window;
  }
  return window->second;
}

Results::Results() : ConsoleReporter(OO_Tabular) {
  SetOutputStream(&std::cerr);
  SetErrorStream(&std::cerr);
}

void Results::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
    for (const auto& [name, counter] : run.counters) {
      const auto least = least_.try_emplace({run.run_name.function_name, name}, counter).first;
      least->second = std::min<double>(least->second, counter);
    }
  }
}

std::optional<double> Results::least(const std::string& benchmark,
                                     const std::string& counter) const {
  const auto value = least_.find({benchmark, counter});
  return value == least_.end() ? std::nullopt : std::optional(value->second);
}

std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::optional(*a / *b) : std::nullopt;
}

std::string cell(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value) || *value == 0) return "-";
  const int before_point = static_cast<int>(std::floor(std::log10(std::abs(*value)))) + 1;
  const double digit = std::pow(10, before_point - 3);
  return fmt::format("{:.{}f}", std::round(*value / digit) * digit, std::max(0, 3 - before_point));
}

std::string whole_number(const std::optional<double>& value) {
  return value && *value != 0 ? fmt::format("{:.0f}", *value) : "-";
}

void print_row(const std::vector<std::string>& cells) {
  fmt::print("| {} |\n", fmt::join(cells, " | "));
}

void print_head(const std::string& titles) {
  std::string line = "---";
  for (const char c : titles)
    if (c == '|') line += " | ---:";
  fmt::print("| {} |\n| {} |\n", titles, line);
}

}  // namespace gpo::bench

/// Measures everything and prints the README's tables. Runs are interleaved, so that ratios hold on
/// a machine whose load changes. Takes Google Benchmark's options, e.g. --benchmark_filter=30x150.
int main(int argc, char** argv) {
  using namespace gpo::bench;
  std::vector<char*> arguments(argv, argv + argc);
  std::string interleaved = "--benchmark_enable_random_interleaving=true";
  arguments.insert(arguments.begin() + 1, interleaved.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  cv::setNumThreads(1);
  register_method_benchmarks();
  register_stage_benchmarks();
  register_view_benchmarks();
  Results results;
  benchmark::RunSpecifiedBenchmarks(&results);
  print_method_tables(results);
  print_stage_tables(results);
  print_view_tables(results);
}
