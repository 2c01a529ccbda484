// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/residuals/pose_block.h"

#include <Eigen/Geometry>

namespace gpo {
namespace {

using FreePose =
    ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
using PoseOnSphere =
    ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::SphereManifold<3>>;

}  // namespace

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

void write_residual(const PointView& view,
                    const Eigen::Vector2d& observed,
                    double* residual,
                    double* d_pose) {
  Eigen::Map<Eigen::Vector2d>{residual} = view.pixel - observed;
  if (d_pose == nullptr) return;
  Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> J(d_pose);
  J << view.d_rotation, view.d_position;
}

void add_pose_blocks(std::span<PoseBlock> cameras,
                     std::optional<int> scale_frame,
                     ceres::Problem& problem,
                     ceres::ParameterBlockOrdering& ordering) {
  auto* const free_pose = new FreePose;  // shared; the problem owns it
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
