// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"
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

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

/// An initializer.
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
  subjects.push_back({"gpo, Ceres, automatic blocks", false, initialize_autodiff_gpo});
  return subjects;
}

/// Sets the counters `optimization` and `initialization` [ms], and `iterations`.
void run_subject(benchmark::State& state, const Subject& subject, const Window& window) {
  std::vector<double> optimization_ms;
  std::vector<double> initialization_ms;
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

void register_subject(const SharedWindows& windows,
                      const Subject& subject,
                      const Size& size,
                      int repetitions) {
  const auto run = [windows, subject, size](benchmark::State& state) {
    run_subject(state, subject, windows->of(size, subject.biased));
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
  print_head({"method",
              "iterations",
              "optimization [ms]",
              "times `gpo`'s",
              "whole initialization [ms]",
              "times `gpo`'s"});
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
        const auto ms = results.least(name_of(subject.name, size), counter);
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
              "per observation and pass [ns]",
              "whole initialization [ms]"});
  Exponent optimization;
  Exponent initialization;
  std::vector<Size> sizes = large_sizes();
  sizes.insert(sizes.begin(), kUsual);
  for (const Size& size : sizes) {
    const auto name = name_of(gpo.name, size);
    const auto optimization_ms = results.least(name, "optimization");
    const auto initialization_ms = results.least(name, "initialization");
    const double iterations = results.least(name, "iterations").value_or(0);
    optimization.add(size.observations(), optimization_ms);
    initialization.add(size.observations(), initialization_ms);
    print_row({fmt::format("{}x{}", size.frames, size.points),
               whole_number(iterations),
               cell(optimization_ms),
               cell(ratio(optimization_ms, size.observations() * (iterations + 1) / 1e6)),
               cell(initialization_ms)});
  }
  fmt::print("\nexponent over frames times points: optimization {}, whole initialization {}\n",
             cell(optimization.value()),
             cell(initialization.value()));
}

}  // namespace

void register_method_benchmarks(const SharedWindows& windows) {
  check_same_minimum(windows->of(kUsual));
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
}

void print_method_tables(const Results& results) {
  print_usual(results);
  print_sizes(results, "optimization");
  print_sizes(results, "initialization");
  print_large(results);
}

}  // namespace gpo::bench
