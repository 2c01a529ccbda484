// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/autodiff_gpo.h"

#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_result.h"
#include "engine/methods/residuals/ceres_solver.h"

#include <memory>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <ceres/ceres.h>

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

}  // namespace

Initialization initialize_autodiff_gpo(const Window& window) {
  const Eigen::Matrix3Xd rays_1 = window.K.inverse() * window.points_px[0].colwise().homogeneous();
  PlaneMotion motion = motion_at_rest(window);
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

}  // namespace gpo::bench
