// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/residuals/point_view.h"

namespace gpo {
namespace {

/// Returns d(R^T v)/dq, columns x y z w, from R^T v = v - 2 w u x v + 2 u x (u x v), q = (u, w).
Eigen::Matrix<double, 3, 4> inverse_rotation_jacobian(const Eigen::Quaterniond& q,
                                                      const Eigen::Vector3d& v) {
  const Eigen::Vector3d u = q.vec();
  Eigen::Matrix<double, 3, 4> J;
  J.leftCols<3>() = 2 * (q.w() * skew(v) + u.dot(v) * Eigen::Matrix3d::Identity() +
                         u * v.transpose() - 2 * v * u.transpose());
  J.col(3) = -2 * u.cross(v);
  return J;
}

using FreePose =
    ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
using PoseOnSphere =
    ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::SphereManifold<3>>;

}  // namespace

PointView view_point(const Intrinsics& intrinsics,
                     const Eigen::Quaterniond& q_wci,
                     const Eigen::Vector3d& p_wci,
                     const Eigen::Vector2d& pixel_1,
                     double inverse_depth) {
  const Eigen::Matrix3d& K = intrinsics.K;
  const Eigen::Vector3d ray_1 = intrinsics.K_inverse * pixel_1.homogeneous();
  const Eigen::Vector3d v = ray_1 - inverse_depth * p_wci;
  const Eigen::Matrix3d R_cw = q_wci.toRotationMatrix().transpose();
  const Eigen::Vector3d y = R_cw * v;
  const Eigen::Vector2d x = y.hnormalized();
  Eigen::Matrix<double, 2, 3> d_y;  // dp/dy
  d_y << 1, 0, -x.x(), 0, 1, -x.y();
  d_y = K.topLeftCorner<2, 2>() * d_y / y.z();
  const Eigen::Matrix<double, 2, 3> d_v = d_y * R_cw;
  PointView view;
  view.pixel = K.topLeftCorner<2, 2>() * x + K.topRightCorner<2, 1>();
  view.d_rotation = d_y * inverse_rotation_jacobian(q_wci, v);
  view.d_position = -inverse_depth * d_v;
  view.d_pixel_1 = d_v * intrinsics.K_inverse.leftCols<2>();
  view.d_inverse_depth = -d_v * p_wci;
  view.in_front = y.z() > 0;
  return view;
}

PlaneDepth depth_on_plane(const Intrinsics& intrinsics,
                          const Eigen::Vector3d& normal,
                          const Eigen::Vector2d& pixel_1) {
  const Eigen::Vector3d ray_1 = intrinsics.K_inverse * pixel_1.homogeneous();
  return {-normal.dot(ray_1),
          -ray_1.transpose(),
          -normal.transpose() * intrinsics.K_inverse.leftCols<2>()};
}

std::vector<PoseBlock> pose_blocks(std::span<const Pose> cameras) {
  std::vector<PoseBlock> blocks(cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Eigen::Map<Eigen::Quaterniond> q(blocks[i].data());
    q = Eigen::Quaterniond(cameras[i].R_wc).normalized();
    Eigen::Map<Eigen::Vector3d> p(blocks[i].data() + 4);
    p = cameras[i].p_wc;
  }
  return blocks;
}

Pose pose_of(const PoseBlock& block) {
  const Eigen::Map<const Eigen::Quaterniond> q(block.data());
  return {q.normalized().toRotationMatrix(), Eigen::Map<const Eigen::Vector3d>(block.data() + 4)};
}

void add_pose_blocks(std::span<PoseBlock> cameras,
                     std::optional<int> scale_frame,
                     ceres::Problem& problem,
                     ceres::ParameterBlockOrdering& ordering) {
  auto* const free_pose = new FreePose;  // owned by the problem
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    double* const block = cameras[i].data();
    ceres::Manifold* manifold = free_pose;
    if (scale_frame && static_cast<std::size_t>(*scale_frame) == i) manifold = new PoseOnSphere;
    problem.AddParameterBlock(block, 7, manifold);
    ordering.AddElementToGroup(block, 1);
  }
  problem.SetParameterBlockConstant(cameras.front().data());
}

}  // namespace gpo
