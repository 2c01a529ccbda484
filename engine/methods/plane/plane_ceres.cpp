// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/decompositions.h"
#include "engine/methods/plane/plane_solver.h"
#include "engine/methods/plane/plane_weights.h"
#include "engine/methods/residuals/ceres_solver.h"
#include "engine/window/window.h"

#include <cstddef>

#include <Eigen/LU>
#include <ceres/normal_prior.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Parameter blocks. The cost of a frame depends on its plane (the quaternion of the main plane's
/// normal or m of a further plane), its translation and, if unknown, on the gyroscope's bias (3)
/// and time offset (4), shared by all frames, and a rotation vector (3) of its own.
struct Blocks {
  Eigen::Quaterniond normal = Eigen::Quaterniond::Identity();
  std::vector<Vector3d> others;
  std::vector<Vector3d> tau;
  Eigen::Vector4d bias_offset = Eigen::Vector4d::Zero();
  std::vector<Vector3d> phi;
};

/// R_wc of a frame with its derivative for each parameter block: R_wc exp(moves dp).
struct Rotation {
  Matrix3d R_wc;
  std::vector<GyroColumns> moves = {};
};

bool is_shared(const PlaneUnknowns& unknowns) { return unknowns.rotations == RotationModel::bias; }
bool is_own(const PlaneUnknowns& unknowns) {
  return unknowns.rotations == RotationModel::free || unknowns.gyro_noise;
}

Rotation rotation_at(const PlaneTask& task,
                     const Matrix3d& R_wc_start,
                     int frame,
                     const double* const* parameters) {
  Rotation rotation{R_wc_start};
  if (is_shared(task.unknowns)) {
    const double* const block = *parameters++;
    const int size = gyro_unknowns(task.window, task.unknowns.rotations);
    PlaneMotion motion;
    motion.bias_rad_s = Eigen::Map<const Vector3d>(block);
    if (size == 4) motion.time_offset_correction_s = block[3];
    rotation.R_wc = gyro_rotation(task.window, frame, motion);
    rotation.moves.push_back(gyro_columns(task.window, motion, frame, size));
  }
  if (is_own(task.unknowns)) {
    const Vector3d phi = Eigen::Map<const Vector3d>(*parameters);
    const Matrix3d R = so3_exp(phi);
    for (GyroColumns& before : rotation.moves) before = R.transpose() * before;
    rotation.R_wc = rotation.R_wc * R;
    rotation.moves.emplace_back(so3_right_jacobian(phi));
  }
  return rotation;
}

/// Transfer errors of one frame's tracks on one plane (engine/method.md, eq. 7). One block per
/// frame is much faster than one per point.
class FrameCost : public ceres::CostFunction {
 public:
  FrameCost(const PlaneTask& task, const Matrix3d& R_wc, int frame, int plane)
      : task_(task),
        observations_(task.observations.plane(plane)[frame]),
        R_wc_(R_wc),
        frame_(frame),
        plane_(plane) {
    *mutable_parameter_block_sizes() = {plane == 0 ? 4 : 3, 3};
    if (is_shared(task.unknowns))
      mutable_parameter_block_sizes()->push_back(
          gyro_unknowns(task.window, task.unknowns.rotations));
    if (is_own(task.unknowns)) mutable_parameter_block_sizes()->push_back(3);
    set_num_residuals(2 * observations_.count);
  }

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector3d> tau(parameters[1]);
    Vector3d m = Eigen::Map<const Vector3d>(parameters[0]);
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 4> d_m = Matrix3d::Identity();
    if (plane_ == 0) {
      const Eigen::Map<const Eigen::Quaterniond> q(parameters[0]);
      m = direction(q);
      d_m = direction_jacobian(q);
    }
    const Rotation rotation = rotation_at(task_, R_wc_, frame_, parameters + 2);
    const Matrix3d R_cw = rotation.R_wc.transpose();
    const FrameState state{.R_cw = R_cw,
                           .tau_c = R_cw * tau,
                           .normal = m,
                           .fx = task_.window.K(0, 0),
                           .fy = task_.window.K(1, 1)};
    for (int k = 0; k < observations_.count; ++k) {
      const Transfer transfer = transfer_of(observations_, state, k);
      if (!transfer.in_front()) return false;
      const double weight = observations_.mask[k];
      Eigen::Map<Eigen::Vector2d> residual(residuals + std::ptrdiff_t{2} * k);
      residual =
          weight * (transfer.pixel - Eigen::Vector2d(observations_.u[k], observations_.v[k]));
      const auto write = [&](int block, const auto& J) {
        if (jacobians == nullptr || jacobians[block] == nullptr) return;
        Eigen::Map<RowMajor<2, Eigen::Dynamic>>(jacobians[block] + 2 * J.cols() * k, 2, J.cols()) =
            weight * J;
      };
      write(0, (transfer.d_normal() * d_m).eval());
      write(1, (transfer.d_translation() * R_cw).eval());
      for (std::size_t r = 0; r < rotation.moves.size(); ++r)
        write(2 + static_cast<int>(r), (transfer.d_rotation() * rotation.moves[r]).eval());
    }
    return true;
  }

 private:
  const PlaneTask& task_;
  const FrameObservations& observations_;
  Matrix3d R_wc_;
  int frame_;
  int plane_;
};

/// Gaussian prior of a parameter block [px].
void add_prior(const Eigen::VectorXd& mean,
               const Eigen::VectorXd& weights,
               double* block,
               ceres::Problem& problem) {
  problem.AddResidualBlock(new ceres::NormalPrior(weights.asDiagonal(), mean), nullptr, block);
}

Blocks parameter_blocks(const PlaneMotion& motion) {
  Blocks blocks;
  blocks.normal = rotation_from_z_axis(motion.normal);
  for (const OtherPlane& other : motion.others) blocks.others.push_back(other.m);
  blocks.tau = motion.tau;
  blocks.bias_offset << motion.bias_rad_s, motion.time_offset_correction_s;
  blocks.phi = motion.gyro_noise_rad;
  blocks.phi.resize(motion.tau.size(), Vector3d::Zero());
  return blocks;
}

PlaneMotion motion_of(const PlaneTask& task, const PlaneMotion& start, const Blocks& blocks) {
  PlaneMotion motion = start;
  motion.normal = direction(blocks.normal).normalized();
  for (std::size_t k = 0; k < blocks.others.size(); ++k) motion.others[k].m = blocks.others[k];
  motion.tau = blocks.tau;
  motion.bias_rad_s = blocks.bias_offset.head<3>();
  motion.time_offset_correction_s = blocks.bias_offset(3);
  for (int i = 1; i < task.window.frame_count(); ++i) {
    if (task.unknowns.rotations == RotationModel::free) motion.R_wc[i] *= so3_exp(blocks.phi[i]);
    if (task.unknowns.gyro_noise) motion.gyro_noise_rad[i] = blocks.phi[i];
    if (is_shared(task.unknowns)) motion.R_wc[i] = gyro_rotation(task.window, i, motion);
  }
  return motion;
}

}  // namespace

PlaneSolution solve_plane_with_ceres(const PlaneTask& task,
                                     const PlaneMotion& given,
                                     const Watch& watch,
                                     double cost_tolerance) {
  const auto& [window, observations, unknowns] = task;
  const PlaneMotion start = with_noise_unknowns(given, unknowns);
  Blocks blocks = parameter_blocks(start);
  ceres::Problem problem;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  double* const normal = blocks.normal.coeffs().data();
  problem.AddParameterBlock(normal, 4, new DirectionManifold);
  ordering->AddElementToGroup(normal, 3);
  if (is_shared(unknowns)) {
    const int size = gyro_unknowns(window, unknowns.rotations);
    Eigen::Vector4d mean;
    mean << window.gyro->prior_rad_s, 0;
    const GyroVector weights = unknowns.sigma_px / gyro_prior_sigmas(window, size).array();
    add_prior(mean.head(size), weights, blocks.bias_offset.data(), problem);
    ordering->AddElementToGroup(blocks.bias_offset.data(), 4);
  }
  for (Vector3d& m : blocks.others) {
    problem.AddParameterBlock(m.data(), 3);
    ordering->AddElementToGroup(m.data(), 1);
  }
  for (int i = 1; i < window.frame_count(); ++i) {
    for (int k = 0; k < observations.plane_count(); ++k) {
      if (observations.plane(k)[i].count == 0) continue;
      double* const plane = k == 0 ? normal : blocks.others[k - 1].data();
      std::vector<double*> parameters{plane, blocks.tau[i].data()};
      if (is_shared(unknowns)) parameters.push_back(blocks.bias_offset.data());
      if (is_own(unknowns)) parameters.push_back(blocks.phi[i].data());
      problem.AddResidualBlock(new FrameCost(task, start.R_wc[i], i, k), nullptr, parameters);
    }
    ordering->AddElementToGroup(blocks.tau[i].data(), 0);  // eliminated first
    if (is_own(unknowns)) ordering->AddElementToGroup(blocks.phi[i].data(), 2);
    if (unknowns.gyro_noise) {
      const double weight = unknowns.sigma_px / gyro_noise_sigma_rad(window, i);
      add_prior(Vector3d::Zero(), Vector3d::Constant(weight), blocks.phi[i].data(), problem);
    }
  }
  const SolverReport solver = solve_by_schur(
      problem, std::move(ordering), {.cost = cost_tolerance}, watch, [&blocks]() -> Vector3d {
        return direction(blocks.normal).normalized();
      });
  return {motion_of(task, start, blocks), solver};
}

}  // namespace gpo
