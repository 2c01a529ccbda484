// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/inertial_alignment.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/tables.h"
#include "tests/engine/inertial/simulated_motion.h"

#include <fmt/format.h>

namespace gpo::bench {
namespace {

constexpr int kSeconds[] = {1, 2, 4};

void align(benchmark::State& state, int seconds) {
  const SimulatedAlignment made = simulated_alignment(ReportTimer::brisk, kPhone, seconds, 1);
  InertialAlignment result;
  measure(state, thread_ms, [&] {
    result = align_inertial(made.poses, made.gyroscope, made.T_body_camera, made.options);
  });
  if (!result.ok) state.SkipWithError(result.reason.c_str());
  state.counters["frames"] = static_cast<double>(made.poses.cameras.size());
}

std::string aligning(int seconds) { return fmt::format("alignment, {} s", seconds); }

}  // namespace

void register_inertial_benchmarks() {
  for (const int seconds : kSeconds)
    benchmark::RegisterBenchmark(aligning(seconds).c_str(),
                                 [seconds](benchmark::State& state) { align(state, seconds); })
        ->MinTime(0.1)
        ->Repetitions(kRepetitions);
}

void print_inertial_tables(const Results& results) {
  fmt::print("\nGravity and meters, 10 samples a frame:\n\n");
  print_head({"frames", "alignment [ms]"});
  for (const int seconds : kSeconds)
    print_row({whole_number(results.least(aligning(seconds), "frames")),
               cell(results.least(aligning(seconds), "ms"))});
}

}  // namespace gpo::bench
