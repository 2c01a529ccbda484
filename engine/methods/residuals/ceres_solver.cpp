// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/residuals/ceres_solver.h"

#include "engine/methods/residuals/direction.h"

#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace gpo {
namespace {

template <int Rows, int Columns>
using RowMajor = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;

/// What of the program is free, as it is now, block by block.
Eigen::VectorXd unknowns_of(const ceres::Problem& problem) {
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  std::vector<double> values;
  for (const double* block : blocks) {
    if (problem.IsParameterBlockConstant(block)) continue;
    values.insert(values.end(), block, block + problem.ParameterBlockSize(block));
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Follows the iterations and ends them where asked to.
class Follower : public ceres::IterationCallback {
 public:
  Follower(const ceres::Problem& problem, const Watch& watch, const ReadNormal& normal)
      : problem_(problem), start_(unknowns_of(problem)), watch_(watch), normal_(normal) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    // Of a refused step, Ceres tells the cost where it would have led.
    const bool moved = iteration.step_is_successful || trace_.empty();
    SolverStep step =
        moved ? SolverStep{iteration.cost, iteration.gradient_max_norm, 0, {}} : trace_.back();
    step.step = moved && !trace_.empty() ? length_of(iteration) : 0;
    if (normal_) step.normal = normal_();
    trace_.push_back(step);
    watch_.tell(static_cast<int>(trace_.size()) - 1, step.cost);
    return watch_.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

  std::vector<SolverStep> trace() && { return std::move(trace_); }

 private:
  /// Of a step that was taken. Ceres 2.2 does not tell that of the first one.
  double length_of(const ceres::IterationSummary& iteration) const {
    if (iteration.step_norm > 0) return iteration.step_norm;
    return (unknowns_of(problem_) - start_).norm();
  }

  const ceres::Problem& problem_;
  const Eigen::VectorXd start_;
  const Watch& watch_;
  const ReadNormal& normal_;
  std::vector<SolverStep> trace_;
};

SolverReport report_of(const ceres::Solver::Summary& summary, std::vector<SolverStep> trace) {
  SolverReport report;
  report.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.unknowns = summary.num_effective_parameters_reduced;
  report.residuals = summary.num_residuals;
  report.milliseconds = 1e3 * summary.total_time_in_seconds;
  report.termination = summary.termination_type == ceres::CONVERGENCE ? Termination::convergence
                       : summary.termination_type == ceres::NO_CONVERGENCE
                           ? Termination::no_convergence
                           : Termination::failure;
  report.trace = std::move(trace);
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
                            const Watch& watch,
                            const ReadNormal& normal) {
  Follower follower(problem, watch, normal);
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
  options.callbacks.push_back(&follower);
  options.update_state_every_iteration = true;  // the follower reads it
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return report_of(summary, std::move(follower).trace());
}

}  // namespace gpo
