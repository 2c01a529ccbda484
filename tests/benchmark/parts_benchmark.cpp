// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/growth.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_kernel.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/peak.h"
#include "tests/benchmark/tables.h"

#include <fmt/format.h>

namespace gpo::bench {
namespace {

/// What GPO consists of, each by itself; one pass: the normal equations of all frames, once.
void register_parts(const SharedWindows& windows) {
  const auto part = [&](const char* name, const auto& work) {
    benchmark::RegisterBenchmark(
        name, [windows, work](benchmark::State& state) { work(state, windows->of(kUsual)); })
        ->MinTime(kLeast_s)
        ->Repetitions(kUsualRepetitions);
  };
  part("part/gather", [](benchmark::State& state, const Window& window) {
    measure(state, thread_ms, [&] { benchmark::DoNotOptimize(plane_observations(window)); });
  });
  part("part/closed form", [](benchmark::State& state, const Window& window) {
    measure(state, thread_ms, [&] { benchmark::DoNotOptimize(closed_form_motion(window)); });
  });
  part("part/pass", [](benchmark::State& state, const Window& window) {
    const PlaneObservations observations = plane_observations(window);
    const PlaneMotion motion = closed_form_motion(window).value();
    measure(state, thread_ms, [&] {
      for (int i = 1; i < window.frame_count(); ++i)
        benchmark::DoNotOptimize(frame_normals(
            observations.frames[i], frame_state(observations, motion, i), Rotating::no));
    });
  });
  part("part/solve", [](benchmark::State& state, const Window& window) {
    measure(state, thread_ms, [&] { benchmark::DoNotOptimize(solve_gpo(window, {}, {})); });
  });
  benchmark::RegisterBenchmark(
      "part/peak",
      [](benchmark::State& state) {
        measure(state, thread_ms, [] { benchmark::DoNotOptimize(peak_operations()); });
      })
      ->MinTime(kLeast_s)
      ->Repetitions(kUsualRepetitions);
}

void register_growth(const SharedWindows& windows, const Size& size) {
  benchmark::RegisterBenchmark(
      name_of("grow", size).c_str(),
      [windows, size](benchmark::State& state) {
        const Window& window = windows->of(size);
        measure(state, thread_ms, [&] { benchmark::DoNotOptimize(grow(window)); });
      })
      ->MinTime(kLeast_s)
      ->Repetitions(kRepetitions);
}

/// With the speed of so many arithmetic operations, zero: not counted.
void print_part(const std::string& part,
                const std::optional<double>& ms,
                double operations,
                const std::optional<double>& peak_gflops) {
  const auto gflops = ratio(operations / 1e6, ms);
  const auto share = ratio(gflops, peak_gflops);
  print_row({part, cell(ms), cell(gflops), cell(ratio(share, 0.01))});
}

/// How far the optimization is from the count of its arithmetic operations.
void print_parts(const Results& results) {
  const auto ms = [&](const char* part) { return results.least(part, "ms"); };
  const auto whole = name_of("gpo", kUsual);
  const double passes = results.least(whole, "iterations").value_or(0) + 1;
  const double operations = kPassOperations * kUsual.observations();
  const auto peak = ratio(kPeakOperations / 1e6, ms("part/peak"));
  fmt::print(
      "\nWhat `gpo` consists of, {} frames, {} points, {} operations of an observation and pass; "
      "the processor's measured peak is {} GFLOP/s:\n\n",
      kUsual.frames,
      kUsual.points,
      kPassOperations,
      cell(peak));
  print_head({"part", "time [ms]", "GFLOP/s", "of the peak [%]"});
  print_part("gathering of the observations", ms("part/gather"), 0, peak);
  print_part("closed form", ms("part/closed form"), 0, peak);
  print_part("one pass over the observations", ms("part/pass"), operations, peak);
  print_part(fmt::format("optimization: {} passes and solves", passes),
             results.least(whole, "optimization"),
             passes * operations,
             peak);
  print_part("all of these", ms("part/solve"), 0, peak);
  print_part("with checks and delivery", results.least(whole, "initialization"), 0, peak);
}

void print_growth(const Results& results) {
  fmt::print("\nGrowing window, {} points:\n\n", kUsual.points);
  print_head({"frames", "all steps [ms]", "a frame [ms]"});
  Exponent exponent;
  for (const Size& size : sizes_over_frames()) {
    const auto ms = results.least(name_of("grow", size), "ms");
    exponent.add(size.frames - 1, ms);
    print_row({std::to_string(size.frames), cell(ms), cell(ratio(ms, size.frames - 1))});
  }
  fmt::print("\nexponent of all steps over frames: {}\n", cell(exponent.value()));
}

}  // namespace

void register_part_benchmarks(const SharedWindows& windows) {
  register_parts(windows);
  for (const Size& size : sizes_over_frames()) register_growth(windows, size);
}

void print_part_tables(const Results& results) {
  print_parts(results);
  print_growth(results);
}

}  // namespace gpo::bench
