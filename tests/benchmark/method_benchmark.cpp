// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/processor.h"
#include "engine/diagnosis/growth.h"
#include "engine/methods/initializers.h"
#include "engine/methods/methods.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_result.h"
#include "engine/methods/residuals/ceres_solver.h"
#include "tests/benchmark/benchmarks.h"

#include <cmath>
#include <functional>
#include <memory>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <ceres/ceres.h>
#include <fmt/format.h>

namespace gpo::bench {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using Sizes = std::vector<Size>;

const Sizes kOverFrames{{5, 150}, {10, 150}, kUsual, {100, 150}, {300, 150}};
const Sizes kOverPoints{{30, 50}, kUsual, {30, 500}, {30, 2000}};
/// Sizes at which only `gpo` is measured.
const Sizes kLarge{{100, 500}, {300, 500}, {100, 2000}, {300, 2000}};

/// Returns the name of a benchmark: "gpo/30x150".
std::string name_of(const std::string& subject, const Size& size) {
  return fmt::format("{}/{}x{}", subject, size.frames, size.points);
}

using Growth = std::vector<std::pair<double, std::optional<double>>>;

/// Estimates k of value ~ size^k by least squares; nullopt for fewer than two values.
std::optional<double> exponent_of(const Growth& growth) {
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const auto& [size, value] : growth) {
    if (!value || !(*value > 0)) continue;
    const double x = std::log(size), y = std::log(*value);
    n += 1;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  if (n < 2) return std::nullopt;
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

/// y = R_cw (I - tau n^T) x_1, residual pi(K y) - p_i [px].
struct TransferError {
  Matrix3d K;
  Matrix3d R_cw;
  Vector3d ray_1;
  Eigen::Vector2d pixel;

  template <class T>
  bool operator()(const T* normal_xyzw, const T* tau, T* residual) const {
    using Vector3 = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Eigen::Quaternion<T>> q(normal_xyzw);
    const Vector3 normal = q * Vector3(T(0), T(0), T(1));
    const T height = normal.dot(ray_1);
    const Vector3 y = R_cw * (ray_1 - Eigen::Map<const Vector3>(tau) * height);
    if (!(y.z() > T(0))) return false;
    residual[0] = K(0, 0) * y.x() / y.z() + K(0, 2) - pixel.x();
    residual[1] = K(1, 1) * y.y() / y.z() + K(1, 2) - pixel.y();
    return true;
  }
};

/// Returns GPO in its most direct implementation, the baseline for our solver: a Ceres problem with
/// an automatically differentiated block for each point and frame over the normal's quaternion and
/// the frame's tau (paper, eq. 8), solved by dogleg with eliminated translations, starting at zero
/// motion.
Initialization initialize_autodiff_gpo(const Window& window) {
  const Eigen::Matrix3Xd rays_1 = window.K.inverse() * window.points_px[0].colwise().homogeneous();
  PlaneMotion motion = motion_without_translation(window);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  ceres::Problem problem;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  problem.AddParameterBlock(q.coeffs().data(), 4, new DirectionManifold);
  ordering->AddElementToGroup(q.coeffs().data(), 1);
  for (int i = 1; i < window.frame_count(); ++i) {
    double* const tau = motion.tau[i].data();
    problem.AddParameterBlock(tau, 3);
    ordering->AddElementToGroup(tau, 0);  // eliminated first
    for (int j = 0; j < window.track_count(); ++j) {
      if (!window.inlier[i][j]) continue;
      auto* const error = new TransferError{
          window.K, window.R_wc[i].transpose(), rays_1.col(j), window.points_px[i].col(j)};
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TransferError, 2, 4, 3>(error),
                               nullptr,
                               q.coeffs().data(),
                               tau);
    }
  }
  const SolverReport solver = solve_by_schur(problem, std::move(ordering), {}, {});
  motion.normal = direction(q).normalized();
  return make_result(window, motion, solver);
}

struct Subject {
  std::string name;
  bool biased = false;  ///< measured with a gyroscope of unknown bias
  std::function<Initialization(const Window&)> initialize;
};

Subject subject(const std::string& name, const std::string& key, Solver solver) {
  const Method& method = find_method(key);
  return {name, !method.rotations, [&method, solver](const Window& window) {
            return method.initialize(window, {.solver = solver}, {});
          }};
}

/// Returns all initializers; the first is the one that the others are compared with.
std::vector<Subject> subjects() {
  std::vector<Subject> subjects;
  for (const Method& method : methods()) {
    subjects.push_back(subject(method.key, method.key, Solver::schur));
    if (method.key.starts_with("gpo"))
      subjects.push_back(subject(method.key + " --solver ceres", method.key, Solver::ceres));
  }
  subjects.push_back({"gpo_joint --error latent", true, [](const Window& window) {
                        return initialize_gpo_joint(window, {.error = ErrorModel::latent}, {});
                      }});
  subjects.push_back({"gpo, Ceres, automatic blocks", false, initialize_autodiff_gpo});
  return subjects;
}

/// Sets the counters `optimization` and `initialization` [ms], and `iterations`.
void run_subject(benchmark::State& state, const Subject& subject, const Window& window) {
  std::vector<double> optimization_ms, initialization_ms;
  Initialization result;
  while (state.KeepRunning()) {
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

void register_subject(const Subject& subject, const Size& size, int repetitions) {
  const auto run = [subject, size](benchmark::State& state) {
    run_subject(state, subject, window_of(size, subject.biased));
  };
  add(name_of(subject.name, size), run, kLeast_s)->Repetitions(repetitions);
}

/// Throws if the automatic blocks have another minimum, which would make the comparison
/// meaningless.
void check_same_minimum(const Window& window) {
  const Initialization ours = find_method("gpo").initialize(window, {}, {});
  const Initialization theirs = initialize_autodiff_gpo(window);
  const double off_deg = angle_deg(ours.plane.normal, theirs.plane.normal);
  const double off_cost = std::abs(ours.solver.final_cost / theirs.solver.final_cost - 1);
  if (!ours.ok || !theirs.ok || !(off_deg < 1e-5) || !(off_cost < 1e-9))
    throw std::runtime_error(
        fmt::format("automatic blocks have another minimum: normal off by {} deg, cost by {}",
                    off_deg,
                    off_cost));
}

void print_usual(const Results& results) {
  fmt::print("{} frames, {} points, 0.5 px noise:\n\n", kUsual.frames, kUsual.points);
  print_head(
      "method | iterations | optimization [ms] | times `gpo`'s | whole initialization [ms] | "
      "times `gpo`'s");
  const auto all = subjects();
  const auto gpo = name_of(all.front().name, kUsual);
  for (const Subject& subject : all) {
    const auto name = name_of(subject.name, kUsual);
    std::vector<std::string> cells{"`" + subject.name + "`",
                                   whole_number(results.least(name, "iterations"))};
    for (const char* counter : {"optimization", "initialization"}) {
      const auto ms = results.least(name, counter);
      cells.push_back(cell(ms));
      cells.push_back(cell(ratio(ms, results.least(gpo, counter))));
    }
    print_row(cells);
  }
}

/// Prints a counter over frames and over points, with the exponents of growth.
void print_sizes(const Results& results, const std::string& counter) {
  fmt::print("\n{} [ms]:\n\n", counter);
  std::string head = "frames x points";
  for (const auto& sizes : {kOverFrames, kOverPoints}) {
    for (const Size& size : sizes) head += fmt::format(" | {}x{}", size.frames, size.points);
    head += " | exponent";
  }
  print_head(head);
  for (const Subject& subject : subjects()) {
    std::vector<std::string> cells{"`" + subject.name + "`"};
    for (const auto& sizes : {kOverFrames, kOverPoints}) {
      Growth growth;
      for (const Size& size : sizes) {
        const auto ms = results.least(name_of(subject.name, size), counter);
        growth.emplace_back(size.observations(), ms);
        cells.push_back(cell(ms));
      }
      cells.push_back(cell(exponent_of(growth)));
    }
    print_row(cells);
  }
}

void print_large(const Results& results) {
  const Subject gpo = subjects().front();
  fmt::print("\n`gpo` on large windows:\n\n");
  print_head(
      "frames x points | iterations | optimization [ms] | per observation and pass [ns] | "
      "whole initialization [ms]");
  Growth optimization, initialization;
  Sizes sizes = kLarge;
  sizes.insert(sizes.begin(), kUsual);
  for (const Size& size : sizes) {
    const auto name = name_of(gpo.name, size);
    const auto optimization_ms = results.least(name, "optimization");
    const auto initialization_ms = results.least(name, "initialization");
    const double iterations = results.least(name, "iterations").value_or(0);
    optimization.emplace_back(size.observations(), optimization_ms);
    initialization.emplace_back(size.observations(), initialization_ms);
    print_row({fmt::format("{}x{}", size.frames, size.points),
               whole_number(iterations),
               cell(optimization_ms),
               cell(ratio(optimization_ms, size.observations() * (iterations + 1) / 1e6)),
               cell(initialization_ms)});
  }
  fmt::print("\nexponent over frames times points: optimization {}, whole initialization {}\n",
             cell(exponent_of(optimization)),
             cell(exponent_of(initialization)));
}

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
void register_parts() {
  const Window& window = window_of(kUsual);
  const auto part = [](const char* name, const auto& work) {
    const auto run = [work](benchmark::State& state) {
      measure(state, thread_ms, [&] { benchmark::DoNotOptimize(work()); });
    };
    add(name, run, kLeast_s)->Repetitions(kUsualRepetitions);
  };
  part("part/gather", [&window] { return plane_observations(window); });
  part("part/closed form", [&window] { return closed_form_motion(window); });
  const PlaneObservations observations = plane_observations(window);
  const PlaneMotion motion = closed_form_motion(window).value();
  part("part/pass", [&window, observations, motion] {
    for (int i = 1; i < window.frame_count(); ++i)
      benchmark::DoNotOptimize(frame_normals(
          observations.frames[i], frame_state(observations, motion, i), Rotating::no));
    return 0;
  });
  part("part/solve", [&window] { return solve_gpo(window, {}, {}); });
  part("part/peak", peak_operations);
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
  print_head("part | time [ms] | GFLOP/s | share of the peak [%]");
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
  print_head("frames | all steps [ms] | per frame [ms]");
  Growth growth;
  for (const Size& size : kOverFrames) {
    const auto ms = results.ms(name_of("grow", size));
    growth.emplace_back(size.frames - 1, ms);
    print_row({std::to_string(size.frames), cell(ms), cell(ratio(ms, size.frames - 1))});
  }
  fmt::print("\nexponent of all steps over frames: {}\n", cell(exponent_of(growth)));
}

}  // namespace

void register_method_benchmarks() {
  check_same_minimum(window_of(kUsual));
  const auto all = subjects();
  for (const Subject& subject : all) {
    register_subject(subject, kUsual, kUsualRepetitions);
    for (const auto& sizes : {kOverFrames, kOverPoints})
      for (const Size& size : sizes)
        if (size != kUsual) register_subject(subject, size, kRepetitions);
  }
  for (const Size& size : kLarge) register_subject(all.front(), size, kRepetitions);
  register_parts();
  for (const Size& size : kOverFrames)
    add(name_of("grow", size), [size](benchmark::State& state) {
      const Window& window = window_of(size);
      measure(state, thread_ms, [&] { benchmark::DoNotOptimize(grow(window)); });
    })->MinTime(kLeast_s);
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
