// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/bundle/plane_adjustment.h"

#include "engine/geometry/nearest_rotation.h"
#include "engine/methods/residuals/ceres_solver.h"
#include "engine/methods/residuals/direction.h"
#include "engine/methods/residuals/point_view.h"
#include "engine/methods/residuals/pose_block.h"

#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// One observation of a point on the plane: residual p - p_observed of (camera, reference pixel,
/// quaternion of the normal).
class PlaneObservationCost : public ceres::SizedCostFunction<2, 7, 2, 4> {
 public:
  PlaneObservationCost(const Intrinsics& intrinsics, const Vector2d& observed)
      : intrinsics_(intrinsics), observed_(observed) {}

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector2d> pixel_1(parameters[1]);
    const Eigen::Map<const Eigen::Quaterniond> q_normal(parameters[2]);
    const PlaneDepth depth = depth_on_plane(intrinsics_, direction(q_normal), pixel_1);
    const PointView view = view_point(intrinsics_,
                                      Eigen::Map<const Eigen::Quaterniond>(parameters[0]),
                                      Eigen::Map<const Vector3d>(parameters[0] + 4),
                                      pixel_1,
                                      depth.inverse_depth);
    if (!view.in_front) return false;
    write_residual(view, observed_, residuals, jacobians == nullptr ? nullptr : jacobians[0]);
    if (jacobians == nullptr) return true;
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>> J(jacobians[1]);
      J = view.d_pixel_1 + view.d_inverse_depth * depth.d_pixel_1;
    }
    if (jacobians[2] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 4, Eigen::RowMajor>> J(jacobians[2]);
      J = view.d_inverse_depth * (depth.d_normal * direction_jacobian(q_normal));
    }
    return true;
  }

 private:
  const Intrinsics& intrinsics_;
  Vector2d observed_;
};

}  // namespace

Bundle free_bundle(const Matrix3d& K, const PlaneBundle& bundle) {
  const Eigen::Matrix3Xd rays = K.inverse() * bundle.pixels_1.colwise().homogeneous();
  Bundle result{bundle.cameras, Eigen::Matrix3Xd(3, rays.cols())};
  result.points << bundle.pixels_1, -bundle.normal.transpose() * rays;
  return result;
}

AdjustedPlaneBundle adjust_plane_bundle(const Matrix3d& K,
                                        const PlaneBundle& start,
                                        std::span<const Observation> observations,
                                        PlaneNormal normal,
                                        const Watch& watch) {
  const Intrinsics intrinsics{K, K.inverse()};
  AdjustedPlaneBundle result{start, {}};
  std::vector<PoseBlock> cameras = pose_blocks(start.cameras);
  Eigen::Quaterniond q_normal = rotation_from_z_axis(start.normal);
  ceres::Problem problem;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  add_pose_blocks(cameras, std::nullopt, problem, *ordering);
  problem.AddParameterBlock(q_normal.coeffs().data(), 4, new DirectionManifold);
  ordering->AddElementToGroup(q_normal.coeffs().data(), 1);
  if (normal == PlaneNormal::held) problem.SetParameterBlockConstant(q_normal.coeffs().data());
  for (const Observation& observation : observations) {
    double* pixel_1 = result.bundle.pixels_1.col(observation.point).data();
    problem.AddResidualBlock(new PlaneObservationCost(intrinsics, observation.pixel),
                             nullptr,
                             cameras[observation.frame].data(),
                             pixel_1,
                             q_normal.coeffs().data());
    ordering->AddElementToGroup(pixel_1, 0);
  }
  const auto normal_now = [&]() -> Vector3d {
    return normal == PlaneNormal::free ? direction(q_normal).normalized() : start.normal;
  };
  result.solver =
      solve_by_schur(problem, std::move(ordering), kAdjustmentTolerances, watch, normal_now);
  for (std::size_t i = 1; i < cameras.size(); ++i) result.bundle.cameras[i] = pose_of(cameras[i]);
  if (normal == PlaneNormal::free) result.bundle.normal = normal_now();
  return result;
}

}  // namespace gpo
