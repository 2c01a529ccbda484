// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"
#include "engine/methods/methods.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/tables.h"

#include <fmt/format.h>
#include <unistd.h>

namespace gpo::bench {
namespace {

namespace fs = std::filesystem;
using Recordings = std::vector<std::shared_ptr<const Recording>>;

constexpr int kJobs[] = {1, 2};

Experiment experiment_on(const Recordings& recordings) {
  ExperimentRequest request{
      {}, parse_ranges("10:30:20", "lengths"), parse_ranges("0:15:5", "starts"), 1};
  for (const Method& method : methods()) request.configurations.push_back({method.key});
  return plan_experiment(recordings, request);
}

std::string name_of(int jobs) { return fmt::format("evaluate/{}", jobs); }

/// Every window anew, pictures still to be decoded.
void run(benchmark::State& state, int jobs) {
  const fs::path folder =
      fs::temp_directory_path() / fmt::format("gpo-evaluate-benchmark-{}", getpid());
  int windows = 0;
  measure(state, wall_ms, [&] {
    fs::remove_all(folder);
    const Recordings recordings{open_recording(GPO_SOURCE_DIR "/sequences/desk")};
    const Experiment experiment = experiment_on(recordings);
    windows = window_count(tasks_of(experiment));
    run_experiment(experiment, recordings, folder, {.jobs = jobs});
  });
  fs::remove_all(folder);
  state.counters["windows"] = windows;
}

}  // namespace

void register_evaluate_benchmarks() {
  for (const int jobs : kJobs) {
    benchmark::RegisterBenchmark(name_of(jobs).c_str(),
                                 [jobs](benchmark::State& state) { run(state, jobs); })
        ->UseRealTime()
        ->Iterations(1)
        ->Repetitions(kRepetitions);
  }
}

void print_evaluate_tables(const Results& results) {
  fmt::print("\n`evaluate` on `sequences/desk`, {} windows of 10 and 30 frames by {} methods:\n\n",
             whole_number(results.least(name_of(1), "windows")),
             methods().size());
  print_head({"`--jobs`", "windows/s"});
  for (const int jobs : kJobs) {
    const auto ms = results.least(name_of(jobs), "ms");
    const auto windows = results.least(name_of(jobs), "windows");
    print_row(
        {std::to_string(jobs), cell(ms ? std::optional(1000 * *windows / *ms) : std::nullopt)});
  }
}

}  // namespace gpo::bench
