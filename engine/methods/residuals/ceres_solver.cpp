// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/residuals/ceres_solver.h"

#include <cmath>
#include <utility>
#include <vector>

namespace gpo {
namespace {

Eigen::Matrix<double, 3, 2> tangents(const Eigen::Quaterniond& q) {
  return q.toRotationMatrix().leftCols<2>();
}

Eigen::Quaterniond exponential(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  const double s = angle < 1e-9 ? 0.5 : std::sin(angle / 2) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(angle / 2);
  q.vec() = s * rotation_rad;
  return q;
}

/// Returns d(q [+] u)/du at u = 0.
Eigen::Matrix<double, 4, 2> plus_jacobian(const Eigen::Quaterniond& q) {
  const Eigen::Matrix<double, 3, 2> N = tangents(q);
  Eigen::Matrix<double, 4, 2> J;
  for (int k = 0; k < 2; ++k) {
    Eigen::Quaterniond imaginary;
    imaginary.w() = 0;
    imaginary.vec() = N.col(k);
    J.col(k) = 0.5 * (imaginary * q).coeffs();
  }
  return J;
}

/// Returns the current values of all free parameters, block by block.
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

/// Records the iterations and aborts on request.
class Follower : public ceres::IterationCallback {
 public:
  Follower(const ceres::Problem& problem, const Watch& watch, const ReadNormal& normal)
      : problem_(problem), start_(unknowns_of(problem)), watch_(watch), normal_(normal) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    // For a rejected step, Ceres reports the cost of the rejected state.
    const bool moved = iteration.step_is_successful || trace_.empty();
    SolverStep step =
        moved ? SolverStep{iteration.cost, iteration.gradient_max_norm, 0, {}} : trace_.back();
    step.step = moved && !trace_.empty() ? length_of(iteration) : 0;
    if (normal_) step.normal = normal_();
    trace_.push_back(step);
    watch_.report(static_cast<int>(trace_.size()) - 1, step.cost);
    return watch_.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

  std::vector<SolverStep> trace() && { return std::move(trace_); }

 private:
  /// Returns the length of an accepted step; Ceres 2.2 does not report that of the first one.
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

Eigen::Vector3d direction(const Eigen::Quaterniond& q) {
  return {2 * (q.x() * q.z() + q.w() * q.y()),
          2 * (q.y() * q.z() - q.w() * q.x()),
          q.w() * q.w() - q.x() * q.x() - q.y() * q.y() + q.z() * q.z()};
}

Eigen::Matrix<double, 3, 4> direction_jacobian(const Eigen::Quaterniond& q) {
  Eigen::Matrix<double, 3, 4> J;
  J << q.z(), q.w(), q.x(), q.y(), -q.w(), q.z(), q.y(), -q.x(), -q.x(), -q.y(), q.z(), q.w();
  return 2 * J;
}

bool DirectionManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Map<const Eigen::Quaterniond> q(x);
  const Eigen::Map<const Eigen::Vector2d> u(delta);
  Eigen::Map<Eigen::Quaterniond>{x_plus_delta} = (exponential(tangents(q) * u) * q).normalized();
  return true;
}

bool DirectionManifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor<4, 2>>{jacobian} = plus_jacobian(Eigen::Map<const Eigen::Quaterniond>(x));
  return true;
}

bool DirectionManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Eigen::Map<const Eigen::Quaterniond> q(x);
  const Eigen::Vector3d from = direction(q);
  const Eigen::Vector3d to = direction(Eigen::Map<const Eigen::Quaterniond>(y));
  const Eigen::Vector3d axis = from.cross(to);
  const double sine = axis.norm();
  const double angle = std::atan2(sine, from.dot(to));
  const double scale = sine < 1e-12 ? 1.0 : angle / sine;
  Eigen::Map<Eigen::Vector2d>{y_minus_x} = tangents(q).transpose() * (scale * axis);
  return true;
}

bool DirectionManifold::MinusJacobian(const double* x, double* jacobian) const {
  // The columns of the Jacobian of Plus are orthogonal with length 1/2.
  Eigen::Map<RowMajor<2, 4>>{jacobian} =
      4 * plus_jacobian(Eigen::Map<const Eigen::Quaterniond>(x)).transpose();
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
  options.num_threads = 1;  // for bitwise repeatability
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&follower);
  options.update_state_every_iteration = true;  // read by the follower
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return report_of(summary, std::move(follower).trace());
}

}  // namespace gpo
