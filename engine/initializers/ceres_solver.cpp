// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/ceres_solver.h"

#include "engine/initializers/transfer.h"

#include <utility>

namespace gpo {
namespace {

template <int Rows, int Columns>
using RowMajor = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;

class StopCallback : public ceres::IterationCallback {
 public:
  explicit StopCallback(std::stop_token stop) : stop_(std::move(stop)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*unused*/) override {
    return stop_.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  std::stop_token stop_;
};

SolverReport report_of(const ceres::Solver::Summary& summary) {
  SolverReport report;
  report.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.unknowns = summary.num_effective_parameters_reduced;
  report.residuals = summary.num_residuals;
  report.milliseconds = 1e3 * summary.total_time_in_seconds;
  report.termination = summary.termination_type == ceres::CONVERGENCE      ? "convergence"
                       : summary.termination_type == ceres::NO_CONVERGENCE ? "no_convergence"
                                                                           : "failure";
  return report;
}

}  // namespace

bool DirectionManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  Eigen::Map<Eigen::Quaterniond> result(x_plus_delta);
  result = direction_plus(Eigen::Map<const Eigen::Quaterniond>(x),
                          Eigen::Map<const Eigen::Vector2d>(delta));
  return true;
}

bool DirectionManifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<4, 2>> J(jacobian);
  J = direction_plus_jacobian(Eigen::Map<const Eigen::Quaterniond>(x));
  return true;
}

bool DirectionManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Eigen::Vector2d> u(y_minus_x);
  u = direction_minus(Eigen::Map<const Eigen::Quaterniond>(y),
                      Eigen::Map<const Eigen::Quaterniond>(x));
  return true;
}

bool DirectionManifold::MinusJacobian(const double* x, double* jacobian) const {
  // The columns of the Jacobian of Plus are orthogonal and of length 1/2.
  Eigen::Map<RowMajor<2, 4>> J(jacobian);
  J = 4 * direction_plus_jacobian(Eigen::Map<const Eigen::Quaterniond>(x)).transpose();
  return true;
}

SolverReport solve_by_schur(ceres::Problem& problem,
                            std::shared_ptr<ceres::ParameterBlockOrdering> ordering,
                            const SolverTolerances& tolerances,
                            const std::stop_token& stop) {
  StopCallback callback(stop);
  ceres::Solver::Options options;
  options.trust_region_strategy_type = ceres::DOGLEG;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = std::move(ordering);
  options.max_num_iterations = 300;
  options.function_tolerance = tolerances.cost;
  options.gradient_tolerance = tolerances.gradient;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;  // more would cost the bit-for-bit repeatability
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return report_of(summary);
}

}  // namespace gpo
