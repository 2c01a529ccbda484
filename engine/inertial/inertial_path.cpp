// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/inertial_path.h"

#include "engine/geometry/pose.h"

namespace gpo {

using Eigen::Matrix3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

std::vector<InertialFrame> inertial_path(std::span<const Preintegration> between,
                                         const Matrix3d& R_first) {
  std::vector<InertialFrame> path(between.size() + 1);
  path.front().R = R_first;
  for (std::size_t k = 0; k < between.size(); ++k) {
    const Preintegration& step = between[k];
    const InertialFrame& a = path[k];
    InertialFrame& b = path[k + 1];
    b.seconds = a.seconds + step.seconds;
    b.R = a.R * step.R;
    b.velocity = a.velocity + a.R * step.velocity;
    b.position = a.position + a.velocity * step.seconds + a.R * step.position;
    const Matrix9 F = moves(a, b);
    // The step's own errors, (phi, velocity, position) in its own axes, into the world's.
    Matrix9 turn = Matrix9::Zero();
    turn.block<3, 3>(0, 0) = b.R;
    turn.block<3, 3>(3, 3) = a.R;
    turn.block<3, 3>(6, 6) = a.R;
    Eigen::Matrix<double, 9, 6> own;
    own << step.R_by_gyro, Matrix3d::Zero(), step.v_by_gyro, step.v_by_acc, step.p_by_gyro,
        step.p_by_acc;
    b.by_biases = F * a.by_biases + turn * own;
    b.covariance = F * a.covariance * F.transpose() + turn * step.covariance * turn.transpose();
  }
  return path;
}

// A turn theta of the earlier frame turns all that is measured after it.
Matrix9 moves(const InertialFrame& earlier, const InertialFrame& later) {
  const double dt = later.seconds - earlier.seconds;
  Matrix9 F = Matrix9::Identity();
  F.block<3, 3>(3, 0) = -skew(later.velocity - earlier.velocity);
  F.block<3, 3>(6, 0) = -skew(later.position - earlier.position - earlier.velocity * dt);
  F.block<3, 3>(6, 3) = dt * Matrix3d::Identity();
  return F;
}

Eigen::MatrixXd position_covariance(std::span<const InertialFrame> path) {
  const auto frames = static_cast<Eigen::Index>(path.size());
  Eigen::MatrixXd all(3 * (frames - 1), 3 * (frames - 1));
  for (Eigen::Index i = 1; i < frames; ++i) {
    const Eigen::Matrix<double, 9, 3> of = path[i].covariance.rightCols<3>();
    for (Eigen::Index j = i; j < frames; ++j) {
      const double dt = path[j].seconds - path[i].seconds;
      const Eigen::Vector3d lever = path[j].position - path[i].position - path[i].velocity * dt;
      const Matrix3d ji =
          of.bottomRows<3>() + dt * of.middleRows<3>(3) - skew(lever) * of.topRows<3>();
      all.block<3, 3>(3 * (j - 1), 3 * (i - 1)) = ji;
      all.block<3, 3>(3 * (i - 1), 3 * (j - 1)) = ji.transpose();
    }
  }
  return all;
}

}  // namespace gpo
