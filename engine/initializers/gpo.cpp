// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/gpo.h"

#include "engine/initializers/map_points.h"
#include "engine/initializers/transfer.h"
#include "engine/initializers/window_checks.h"

#include <memory>

#include <Eigen/LU>
#include <ceres/ceres.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
template <int Rows, int Columns>
using RowMajor = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;

/// The unit quaternion of the normal; its tangent is two-dimensional (Bloesch et al.).
class DirectionManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 2; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Eigen::Map<const Eigen::Quaterniond> q(x);
    Eigen::Map<Eigen::Quaterniond> result(x_plus_delta);
    result = direction_plus(q, Eigen::Map<const Eigen::Vector2d>(delta));
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<RowMajor<4, 2>> J(jacobian);
    J = direction_plus_jacobian(Eigen::Map<const Eigen::Quaterniond>(x));
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Eigen::Vector2d> u(y_minus_x);
    u = direction_minus(Eigen::Map<const Eigen::Quaterniond>(y),
                        Eigen::Map<const Eigen::Quaterniond>(x));
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    // The columns of the Jacobian of Plus are orthogonal and of length 1/2.
    Eigen::Map<RowMajor<2, 4>> J(jacobian);
    J = 4 * direction_plus_jacobian(Eigen::Map<const Eigen::Quaterniond>(x)).transpose();
    return true;
  }
};

/// Transfer errors of all inliers of one frame (paper, eq. 8): one block a frame, not one a point,
/// is what makes the solve fast.
class FrameCost : public ceres::CostFunction {
 public:
  FrameCost(const Window& window, int frame, const Eigen::Matrix3Xd& rays_1)
      : window_(window), frame_(frame), rays_1_(rays_1) {
    for (int j = 0; j < window.track_count(); ++j) {
      if (window.inlier[frame][j]) inliers_.push_back(j);
    }
    *mutable_parameter_block_sizes() = {4, 3};
    set_num_residuals(static_cast<int>(2 * inliers_.size()));
  }

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::Quaterniond> q(parameters[0]);
    const Eigen::Map<const Vector3d> tau(parameters[1]);
    const Vector3d normal = direction(q);
    const Eigen::Matrix<double, 3, 4> d_q = direction_jacobian(q);
    for (std::size_t k = 0; k < inliers_.size(); ++k) {
      const Transfer transfer =
          transfer_on_plane(window_.K, window_.R_wc[frame_], rays_1_.col(inliers_[k]), normal, tau);
      if (!transfer.in_front) return false;
      Eigen::Map<Eigen::Vector2d> residual(residuals + 2 * k);
      residual = transfer.pixel - window_.points_px[frame_].col(inliers_[k]);
      if (jacobians == nullptr) continue;
      if (jacobians[0] != nullptr) {
        Eigen::Map<RowMajor<2, 4>> J(jacobians[0] + 8 * k);
        J = transfer.d_normal * d_q;
      }
      if (jacobians[1] != nullptr) {
        Eigen::Map<RowMajor<2, 3>> J(jacobians[1] + 6 * k);
        J = transfer.d_tau;
      }
    }
    return true;
  }

 private:
  const Window& window_;
  int frame_;
  const Eigen::Matrix3Xd& rays_1_;
  std::vector<int> inliers_;
};

class StopCallback : public ceres::IterationCallback {
 public:
  explicit StopCallback(std::stop_token stop) : stop_(std::move(stop)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*unused*/) override {
    return stop_.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  std::stop_token stop_;
};

struct Unknowns {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< the normal starts along z
  std::vector<Vector3d> tau;                              ///< and all translations at zero
};

SolverReport report_of(const ceres::Solver::Summary& summary) {
  SolverReport report;
  report.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.unknowns = summary.num_effective_parameters;
  report.residuals = summary.num_residuals;
  report.milliseconds = 1e3 * summary.total_time_in_seconds;
  report.termination = summary.termination_type == ceres::CONVERGENCE      ? "convergence"
                       : summary.termination_type == ceres::NO_CONVERGENCE ? "no_convergence"
                                                                           : "failure";
  return report;
}

SolverReport solve(const Window& window, Unknowns& unknowns, std::stop_token stop) {
  const Eigen::Matrix3Xd rays_1 = window.K.inverse() * window.points_px[0].colwise().homogeneous();
  ceres::Problem problem;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  problem.AddParameterBlock(unknowns.q.coeffs().data(), 4, new DirectionManifold);
  ordering->AddElementToGroup(unknowns.q.coeffs().data(), 1);
  for (int i = 1; i < window.frame_count(); ++i) {
    double* tau = unknowns.tau[i].data();
    problem.AddResidualBlock(
        new FrameCost(window, i, rays_1), nullptr, unknowns.q.coeffs().data(), tau);
    ordering->AddElementToGroup(tau, 0);  // eliminated first: the Schur complement is 2x2
  }
  StopCallback callback(std::move(stop));
  ceres::Solver::Options options;
  options.trust_region_strategy_type = ceres::DOGLEG;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = ordering;
  options.max_num_iterations = 300;
  options.function_tolerance = 1e-12;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;  // more would cost the bit-for-bit repeatability
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return report_of(summary);
}

/// Sign and gauge: (n, tau) and (-n, -tau) give the same pictures; points lie in front, d = 1.
Initialization deliver(const Window& window, const Unknowns& unknowns) {
  Initialization result;
  const Vector3d n = direction(unknowns.q).normalized();
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  int in_front = 0;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[0][j]) continue;
    in_front += n.dot(K_inverse * window.points_px[0].col(j).homogeneous()) < 0 ? 1 : -1;
  }
  const double sign = in_front > 0 ? 1 : -1;
  result.plane = {sign * n, 1};
  for (int i = 0; i < window.frame_count(); ++i) {
    const Vector3d p_wc = Vector3d::Zero() - sign * unknowns.tau[i];  // p_wci = -d tau_i, no -0
    result.cameras.push_back({window.R_wc[i], p_wc});
  }
  return result;
}

}  // namespace

Initialization initialize_gpo(const Window& window, std::stop_token stop) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  Unknowns unknowns;
  unknowns.tau.assign(window.frame_count(), Vector3d::Zero());
  const SolverReport solver = solve(window, unknowns, std::move(stop));
  if (solver.termination != "convergence") {
    return failed(fmt::format("no convergence after {} iterations", solver.iterations), solver);
  }
  Initialization result = deliver(window, unknowns);
  result.solver = solver;
  if (auto reason = reason_to_distrust(window, result.plane, result.cameras))
    return failed(*reason, solver);
  result.points = lift_to_plane(window, result.plane, result.cameras);
  result.rms_px = root_mean_square(reprojection_errors_px(window, result.plane, result.cameras));
  result.ok = true;
  return result;
}

}  // namespace gpo
