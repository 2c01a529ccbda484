// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/gpo.h"

#include "engine/initializers/ceres_solver.h"
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

struct Unknowns {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< the normal starts along z
  std::vector<Vector3d> tau;                              ///< and all translations at zero
};

SolverReport solve(const Window& window, Unknowns& unknowns, const std::stop_token& stop) {
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
  return solve_by_schur(problem, std::move(ordering), {}, stop);
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

Initialization initialize_gpo(const Window& window,
                              const InitializerOptions& /*options*/,
                              const std::stop_token& stop) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  Unknowns unknowns;
  unknowns.tau.assign(window.frame_count(), Vector3d::Zero());
  const SolverReport solver = solve(window, unknowns, stop);
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
