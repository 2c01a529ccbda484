// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/benchmarks.h"

#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>

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
  const auto windows = std::make_shared<Windows>();
  register_method_benchmarks(windows);
  register_part_benchmarks(windows);
  register_stage_benchmarks();
  register_view_benchmarks();
  Results results;
  benchmark::RunSpecifiedBenchmarks(&results);
  print_method_tables(results);
  print_part_tables(results);
  print_stage_tables(results);
  print_view_tables(results);
}
