// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/processor.h"
#include "engine/methods/certainty/growth.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_kernel.h"
#include "tests/benchmark/benchmarks.h"

#include <fmt/format.h>

namespace gpo::bench {
namespace {

/// Floating-point operations of the kernel for known rotations per observation and pass, a fused
/// multiply-add counting as two: counted in the loop that GCC compiles from plane_kernel.cpp.
constexpr double kPassOperations = 100;

/// Floating-point operations of one call of `peak_operations`.
constexpr double kPeakOperations = 10000.0 * 10 * 4 * 2;

[[gnu::always_inline]] inline double multiply_add() {
  using Vector = double __attribute__((vector_size(32)));
  constexpr int kChains = 10;  // two units with a latency of four cycles need eight
  constexpr int kSteps = static_cast<int>(kPeakOperations) / (kChains * 8);
  Vector sum[kChains] = {};
  const volatile double half = 0.5;  // hidden from the optimizer
  const Vector factor = {half, half, half, half};
  for (int step = 0; step < kSteps; ++step)
    for (Vector& chain : sum) chain = chain * factor + factor;
  for (int k = 1; k < kChains; ++k) sum[0] += sum[k];
  return sum[0][0] + sum[0][1] + sum[0][2] + sum[0][3];
}

[[gnu::target("avx2,fma")]] double multiply_add_avx2_fma() { return multiply_add(); }

/// Runs independent fused multiply-adds in registers only: the processor's peak with the vectors of
/// the kernel. Returns their sum.
double peak_operations() { return has_avx2_fma() ? multiply_add_avx2_fma() : multiply_add(); }

/// Registers the parts of GPO. One pass computes the normal equations of all frames once.
void register_parts(const SharedWindows& windows) {
  const auto part = [&](const char* name, const auto& work) {
    const auto run = [windows, work](benchmark::State& state) { work(state, windows->of(kUsual)); };
    add(name, run, kLeast_s)->Repetitions(kUsualRepetitions);
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
  part("part/peak", [](benchmark::State& state, const Window& /*window*/) {
    measure(state, thread_ms, [] { benchmark::DoNotOptimize(peak_operations()); });
  });
}

void register_growth(const SharedWindows& windows, const Size& size) {
  const auto run = [windows, size](benchmark::State& state) {
    const Window& window = windows->of(size);
    measure(state, thread_ms, [&] { benchmark::DoNotOptimize(grow(window)); });
  };
  add(name_of("grow", size), run, kLeast_s);
}

/// `operations`: arithmetic operations; 0 if not counted.
void print_part(const std::string& part,
                const std::optional<double>& ms,
                double operations,
                const std::optional<double>& peak_gflops) {
  const auto gflops = ratio(operations / 1e6, ms);
  const auto share = ratio(gflops, peak_gflops);
  print_row({part, cell(ms), cell(gflops), cell(ratio(share, 0.01))});
}

/// Compares the optimization with its number of arithmetic operations.
void print_parts(const Results& results) {
  const auto ms = [&](const char* part) { return results.ms(part); };
  const auto whole = name_of("gpo", kUsual);
  const double passes = results.least(whole, "iterations").value_or(0) + 1;
  const double operations = kPassOperations * kUsual.observations();
  const auto peak = ratio(kPeakOperations / 1e6, ms("part/peak"));
  fmt::print(
      "\nParts of `gpo`, {} frames, {} points, {} operations per observation and pass; the "
      "processor's measured peak is {} GFLOP/s:\n\n",
      kUsual.frames,
      kUsual.points,
      kPassOperations,
      cell(peak));
  print_head({"part", "time [ms]", "GFLOP/s", "share of the peak [%]"});
  print_part("gathering of the observations", ms("part/gather"), 0, peak);
  print_part("closed form", ms("part/closed form"), 0, peak);
  print_part("one pass over the observations", ms("part/pass"), operations, peak);
  print_part(fmt::format("optimization: {} passes and solves", passes),
             results.least(whole, "optimization"),
             passes * operations,
             peak);
  print_part("all of these", ms("part/solve"), 0, peak);
  print_part("with checks and result", results.least(whole, "initialization"), 0, peak);
}

void print_growth(const Results& results) {
  fmt::print("\nGrowing window, {} points:\n\n", kUsual.points);
  print_head({"frames", "all steps [ms]", "per frame [ms]"});
  Exponent exponent;
  for (const Size& size : sizes_over_frames()) {
    const auto ms = results.ms(name_of("grow", size));
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
