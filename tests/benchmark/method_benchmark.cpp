// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/closed_form.h"
#include "engine/initializers/gpo.h"
#include "engine/initializers/growth.h"
#include "engine/initializers/methods.h"
#include "engine/initializers/plane_kernel.h"
#include "tests/benchmark/autodiff_gpo.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/peak.h"
#include "tests/benchmark/tables.h"
#include "tests/engine/simulated_window.h"

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <tuple>

#include <fmt/format.h>

namespace gpo::bench {
namespace {

struct Size {
  int frames;
  int points;

  auto operator<=>(const Size&) const = default;
  int observations() const { return (frames - 1) * points; }
};

constexpr Size kUsual{30, 150};
constexpr int kUsualRepetitions = 15;
constexpr int kRepetitions = 3;
constexpr double kLeast_s = 0.02;  // of a repetition

std::vector<Size> sizes_over_frames() {
  return {{5, 150}, {10, 150}, kUsual, {100, 150}, {300, 150}};
}
std::vector<Size> sizes_over_points() { return {{30, 50}, kUsual, {30, 500}, {30, 2000}}; }
/// Beyond what the other methods are measured on.
std::vector<Size> large_sizes() { return {{100, 500}, {300, 500}, {100, 2000}, {300, 2000}}; }

/// What is measured: anything that initializes.
struct Subject {
  std::string name;
  bool biased = false;  ///< on a window whose gyroscope has an unknown bias
  std::function<Initialization(const Window&)> initialize;
};

/// Simulated once, when first asked for.
class Windows {
 public:
  const Window& of(const Size& size, bool biased) {
    const auto [window, first] = windows_.try_emplace({size, biased});
    if (first) {
      test::SimulationOptions options;
      options.frames = size.frames;
      options.points = size.points;
      if (biased) {
        options.gyro_bias_rad_s = 0.002;
        options.gyro_noise_rad_s = 0.002;
      }
      window->second = test::with_fitted_homographies(test::simulate(options)).window;
    }
    return window->second;
  }

 private:
  std::map<std::pair<Size, bool>, Window> windows_;
};
using SharedWindows = std::shared_ptr<Windows>;

Subject subject(const std::string& name, const std::string& key, Solver solver) {
  const Method& method = find_method(key);
  return {name, !method.rotations, [&method, solver](const Window& window) {
            return method.initialize(window, {.solver = solver}, {});
          }};
}

/// Our own solver first: the others are compared with it.
std::vector<Subject> subjects() {
  std::vector<Subject> subjects;
  for (const Method& method : methods()) {
    subjects.push_back(subject(method.key, method.key, Solver::schur));
    if (method.key.starts_with("gpo"))
      subjects.push_back(subject(method.key + " --solver ceres", method.key, Solver::ceres));
  }
  subjects.push_back({"gpo, Ceres, automatic blocks", false, initialize_autodiff_gpo});
  return subjects;
}

std::string name_of(const Subject& subject, const Size& size) {
  return fmt::format("{}/{}x{}", subject.name, size.frames, size.points);
}

/// Counters `optimization` and `initialization` [ms].
void run_subject(benchmark::State& state, const Subject& subject, const Window& window) {
  std::vector<double> optimization_ms;
  std::vector<double> initialization_ms;
  Initialization result;
  for (auto _ : state) {
    const double begin = thread_ms();
    result = subject.initialize(window);
    initialization_ms.push_back(thread_ms() - begin);
    optimization_ms.push_back(result.solver.milliseconds);
  }
  if (!result.ok) return state.SkipWithError(result.reason.c_str());
  state.counters["optimization"] = median(std::move(optimization_ms));
  state.counters["initialization"] = median(std::move(initialization_ms));
  state.counters["iterations"] = result.solver.iterations;
}

void register_subject(const SharedWindows& windows,
                      const Subject& subject,
                      const Size& size,
                      int repetitions) {
  benchmark::RegisterBenchmark(name_of(subject, size).c_str(),
                               [windows, subject, size](benchmark::State& state) {
                                 run_subject(state, subject, windows->of(size, subject.biased));
                               })
      ->MinTime(kLeast_s)
      ->Repetitions(repetitions);
}

/// The automatic blocks end where our solver does, or the comparison is worth nothing.
void check_same_minimum(const Window& window) {
  const Initialization ours = find_method("gpo").initialize(window, {}, {});
  const Initialization theirs = initialize_autodiff_gpo(window);
  const double off_deg = angle_deg(ours.plane.normal, theirs.plane.normal);
  const double off_cost = std::abs(ours.solver.final_cost / theirs.solver.final_cost - 1);
  if (!ours.ok || !theirs.ok || !(off_deg < 1e-5) || !(off_cost < 1e-9))
    throw std::runtime_error(fmt::format(
        "automatic blocks end elsewhere: normal by {} deg, cost by {}", off_deg, off_cost));
}

/// What GPO consists of, each by itself; one pass: the normal equations of all frames, once.
void register_parts(const SharedWindows& windows) {
  const auto part = [&](const char* name, const auto& work) {
    benchmark::RegisterBenchmark(
        name, [windows, work](benchmark::State& state) { work(state, windows->of(kUsual, false)); })
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

std::string growth_name(const Size& size) {
  return fmt::format("grow/{}x{}", size.frames, size.points);
}

void register_growth(const SharedWindows& windows, const Size& size) {
  benchmark::RegisterBenchmark(
      growth_name(size).c_str(),
      [windows, size](benchmark::State& state) {
        const Window& window = windows->of(size, false);
        measure(state, thread_ms, [&] { benchmark::DoNotOptimize(grow(window)); });
      })
      ->MinTime(kLeast_s)
      ->Repetitions(kRepetitions);
}

std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return std::nullopt;
  return *a / *b;
}

/// k of value ~ size^k by least squares; nothing of less than two.
class Exponent {
 public:
  void add(double size, const std::optional<double>& value) {
    if (!value || !(*value > 0)) return;
    const double x = std::log(size);
    const double y = std::log(*value);
    n_ += 1;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    xy_ += x * y;
  }
  std::optional<double> value() const {
    if (n_ < 2) return std::nullopt;
    return (n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_);
  }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

void print_usual(const Results& results) {
  fmt::print("{} frames, {} points, 0.5 px noise:\n\n", kUsual.frames, kUsual.points);
  print_head({"method",
              "optimization [ms]",
              "times `gpo`'s",
              "whole initialization [ms]",
              "times `gpo`'s"});
  const auto all = subjects();
  const auto gpo = name_of(all.front(), kUsual);
  for (const Subject& subject : all) {
    const auto name = name_of(subject, kUsual);
    std::vector<std::string> cells{"`" + subject.name + "`"};
    for (const char* counter : {"optimization", "initialization"}) {
      const auto ms = results.least(name, counter);
      cells.push_back(cell(ms));
      cells.push_back(cell(ratio(ms, results.least(gpo, counter))));
    }
    print_row(cells);
  }
}

/// One of the counters over frames and over points, with the exponents of growth.
void print_sizes(const Results& results, const std::string& counter) {
  fmt::print("\n{} [ms]:\n\n", counter);
  std::vector<std::string> head{"frames x points"};
  for (const auto& sizes : {sizes_over_frames(), sizes_over_points()}) {
    for (const Size& size : sizes) head.push_back(fmt::format("{}x{}", size.frames, size.points));
    head.emplace_back("exponent");
  }
  print_head(head);
  for (const Subject& subject : subjects()) {
    std::vector<std::string> cells{"`" + subject.name + "`"};
    for (const auto& sizes : {sizes_over_frames(), sizes_over_points()}) {
      Exponent exponent;
      for (const Size& size : sizes) {
        const auto ms = results.least(name_of(subject, size), counter);
        exponent.add(size.observations(), ms);
        cells.push_back(cell(ms));
      }
      cells.push_back(cell(exponent.value()));
    }
    print_row(cells);
  }
}

void print_large(const Results& results) {
  const Subject gpo = subjects().front();
  fmt::print("\n`gpo` on large windows:\n\n");
  print_head({"frames x points",
              "iterations",
              "optimization [ms]",
              "of an observation and pass [ns]",
              "whole initialization [ms]"});
  Exponent optimization;
  Exponent initialization;
  std::vector<Size> sizes = large_sizes();
  sizes.insert(sizes.begin(), kUsual);
  for (const Size& size : sizes) {
    const auto name = name_of(gpo, size);
    const auto optimization_ms = results.least(name, "optimization");
    const auto initialization_ms = results.least(name, "initialization");
    const double iterations = results.least(name, "iterations").value_or(0);
    optimization.add(size.observations(), optimization_ms);
    initialization.add(size.observations(), initialization_ms);
    print_row({fmt::format("{}x{}", size.frames, size.points),
               cell(iterations),
               cell(optimization_ms),
               cell(ratio(optimization_ms, size.observations() * (iterations + 1) / 1e6)),
               cell(initialization_ms)});
  }
  fmt::print("\nexponent over frames times points: optimization {}, whole initialization {}\n",
             cell(optimization.value()),
             cell(initialization.value()));
}

/// How far the optimization is from the count of its arithmetic operations.
void print_parts(const Results& results) {
  const auto name = name_of(subjects().front(), kUsual);
  const double iterations = results.least(name, "iterations").value_or(0);
  const double operations = kPassOperations * kUsual.observations();  // of a pass
  const auto peak = ratio(kPeakOperations / 1e6, results.least("part/peak", "ms"));
  const auto speed = [&](double count, const std::optional<double>& ms) {
    const auto gflops = ratio(count / 1e6, ms);
    return std::pair(cell(gflops),
                     cell(ratio(gflops ? std::optional(100 * *gflops) : gflops, peak)));
  };
  fmt::print("\nWhat `gpo` consists of ({} operations of an observation and pass):\n\n",
             kPassOperations);
  print_head({"part", "time [ms]", "GFLOP/s", "of the processor's peak [%]"});
  const auto pass_ms = results.least("part/pass", "ms");
  const auto [pass, pass_share] = speed(operations, pass_ms);
  const auto optimization_ms = results.least(name, "optimization");
  const auto [all, all_share] = speed((iterations + 1) * operations, optimization_ms);
  print_row({"gather the observations", cell(results.least("part/gather", "ms")), "", ""});
  print_row({"closed form", cell(results.least("part/closed form", "ms")), "", ""});
  print_row({"one pass over the observations", cell(pass_ms), pass, pass_share});
  print_row({fmt::format("optimization: {} passes, solves", iterations + 1),
             cell(optimization_ms),
             all,
             all_share});
  print_row({"all of these", cell(results.least("part/solve", "ms")), "", ""});
  print_row({"with checks and delivery", cell(results.least(name, "initialization")), "", ""});
  fmt::print("\nmeasured peak: {} GFLOP/s\n", cell(peak));
}

void print_growth(const Results& results) {
  fmt::print("\nGrowing window, {} points:\n\n", kUsual.points);
  print_head({"frames", "all steps [ms]", "a frame [ms]"});
  Exponent exponent;
  for (const Size& size : sizes_over_frames()) {
    const auto ms = results.least(growth_name(size), "ms");
    exponent.add(size.frames - 1, ms);
    print_row({std::to_string(size.frames), cell(ms), cell(ratio(ms, size.frames - 1))});
  }
  fmt::print("\nexponent of all steps over frames: {}\n", cell(exponent.value()));
}

}  // namespace

void register_method_benchmarks() {
  const auto windows = std::make_shared<Windows>();
  check_same_minimum(windows->of(kUsual, false));
  const auto all = subjects();
  for (const Subject& subject : all) {
    register_subject(windows, subject, kUsual, kUsualRepetitions);
    for (const auto& sizes : {sizes_over_frames(), sizes_over_points()}) {
      for (const Size& size : sizes) {
        if (size != kUsual) register_subject(windows, subject, size, kRepetitions);
      }
    }
  }
  for (const Size& size : large_sizes()) register_subject(windows, all.front(), size, kRepetitions);
  register_parts(windows);
  for (const Size& size : sizes_over_frames()) register_growth(windows, size);
}

void print_method_tables(const Results& results) {
  print_usual(results);
  print_sizes(results, "optimization");
  print_sizes(results, "initialization");
  print_large(results);
  print_parts(results);
  print_growth(results);
}

}  // namespace gpo::bench
