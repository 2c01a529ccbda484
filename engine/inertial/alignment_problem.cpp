// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/alignment_problem.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"

#include <cmath>

#include <Eigen/Geometry>

namespace gpo {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Part of the residuals that does not depend on scale, velocity and gravity.
VectorXd measured(const AlignmentProblem& problem, const Vector3d& bias, const Vector3d& lever) {
  VectorXd all(problem.centers.size());
  const Matrix3d& R_first = problem.path.front().R;
  for (std::size_t k = 1; k < problem.path.size(); ++k) {
    const InertialFrame& frame = problem.path[k];
    const Matrix3d by_acc = frame.by_biases.bottomRightCorner<3, 3>();
    all.segment<3>(3 * (static_cast<Eigen::Index>(k) - 1)) =
        (frame.R - R_first) * lever + frame.position + by_acc * bias;
  }
  return all;
}

/// Solves s c_k - v t_k - (g_0 + B y) t_k^2 / 2 = measured for (s, v, y).
VectorXd linear_solution(const AlignmentProblem& problem, const Vector3d& g_0, const MatrixXd& B) {
  const Eigen::Index rows = problem.centers.size();
  MatrixXd A(rows, 4 + B.cols());
  VectorXd b = measured(problem, Vector3d::Zero(), problem.lever_m);
  A.col(0) = problem.centers;
  for (std::size_t k = 1; k < problem.path.size(); ++k) {
    const double t = problem.path[k].seconds;
    const auto row = 3 * (static_cast<Eigen::Index>(k) - 1);
    A.block<3, 3>(row, 1) = -t * Matrix3d::Identity();
    A.block(row, 4, 3, B.cols()) = -0.5 * t * t * B;
    b.segment<3>(row) += 0.5 * t * t * g_0;
  }
  return least_squares(A, b);
}

}  // namespace

AlignmentState stepped(const AlignmentState& state, const VectorXd& step) {
  AlignmentState next = state;
  next.velocity += step.head<3>();
  const Vector3d down = state.gravity.normalized();
  const Vector3d rotated = down + normal_tangents(down) * step.segment<2>(3);
  next.gravity = state.gravity.norm() * rotated.normalized();
  next.log_scale += step(kScaleUnknown);
  next.bias += step.segment<3>(6);
  next.lever += step.segment<3>(9);
  return next;
}

VectorXd residuals(const AlignmentProblem& problem, const AlignmentState& state) {
  VectorXd all =
      std::exp(state.log_scale) * problem.centers - measured(problem, state.bias, state.lever);
  for (std::size_t k = 1; k < problem.path.size(); ++k) {
    const double t = problem.path[k].seconds;
    all.segment<3>(3 * (static_cast<Eigen::Index>(k) - 1)) -=
        t * state.velocity + 0.5 * t * t * state.gravity;
  }
  return all;
}

MatrixXd jacobian(const AlignmentProblem& problem,
                  const AlignmentState& state,
                  const VectorXd& meters) {
  MatrixXd J(meters.size(), kAlignmentUnknowns);
  const auto tangents = normal_tangents(state.gravity.normalized());
  J.col(kScaleUnknown) = meters;
  for (std::size_t k = 1; k < problem.path.size(); ++k) {
    const InertialFrame& frame = problem.path[k];
    const double t = frame.seconds;
    const auto row = 3 * (static_cast<Eigen::Index>(k) - 1);
    J.block<3, 3>(row, 0) = -t * Matrix3d::Identity();
    J.block<3, 2>(row, 3) = -0.5 * t * t * state.gravity.norm() * tangents;
    J.block<3, 3>(row, 6) = -frame.by_biases.bottomRightCorner<3, 3>();
    J.block<3, 3>(row, 9) = problem.path.front().R - frame.R;
  }
  return J;
}

MatrixXd by_gyro_bias(const AlignmentProblem& problem, const AlignmentState& state) {
  MatrixXd J(problem.centers.size(), 3);
  for (std::size_t k = 1; k < problem.path.size(); ++k) {
    const InertialFrame& frame = problem.path[k];
    J.middleRows<3>(3 * (static_cast<Eigen::Index>(k) - 1)) =
        skew(frame.R * state.lever) * frame.by_biases.topLeftCorner<3, 3>() -
        frame.by_biases.bottomLeftCorner<3, 3>();
  }
  return J;
}

std::vector<VectorXd> changes_by_scales(const AlignmentProblem& problem,
                                        const AlignmentState& state,
                                        std::span<const Preintegration> between,
                                        double gravity_share,
                                        double force_share) {
  const VectorXd r = residuals(problem, state);
  AlignmentState longer = state;
  longer.gravity *= 1 + gravity_share;
  std::vector<VectorXd> changes{residuals(problem, longer) - r};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Preintegration> scaled(between.begin(), between.end());
    for (Preintegration& one : scaled) {
      one.velocity(axis) *= 1 + force_share;
      one.position(axis) *= 1 + force_share;
    }
    AlignmentProblem other = problem;
    other.path = inertial_path(scaled, problem.path.front().R);
    changes.push_back(residuals(other, state) - r);
  }
  return changes;
}

std::vector<Eigen::Vector3d> velocities(const AlignmentProblem& problem,
                                        const AlignmentState& state) {
  std::vector<Eigen::Vector3d> all;
  for (const InertialFrame& frame : problem.path)
    all.emplace_back(state.velocity + frame.seconds * state.gravity + frame.velocity +
                     frame.by_biases.block<3, 3>(3, 3) * state.bias);
  return all;
}

AlignmentState linear_start(const AlignmentProblem& problem, double gravity_m_s2) {
  constexpr int kRounds = 3;
  constexpr double kLeastScale = 1e-3;
  VectorXd x = linear_solution(problem, Vector3d::Zero(), Matrix3d::Identity());
  Vector3d g = gravity_m_s2 * x.tail<3>().normalized();
  for (int round = 0; round < kRounds; ++round) {
    const MatrixXd B = gravity_m_s2 * normal_tangents(g.normalized());
    x = linear_solution(problem, g, B);
    g = gravity_m_s2 * (g + B * x.tail<2>()).normalized();
  }
  AlignmentState state;
  state.velocity = x.segment<3>(1);
  state.gravity = g;
  state.log_scale = std::log(std::max(x(0), kLeastScale));
  state.lever = problem.lever_m;
  return state;
}

std::optional<ResidualNoise> residual_noise(const AlignmentProblem& problem,
                                            const AlignmentState& state) {
  const Eigen::Index rows = problem.centers.size();
  const double s = std::exp(state.log_scale);
  ResidualNoise noise;
  noise.log_scale = state.log_scale;
  noise.with_bias = s * problem.covariance.topRightCorner(rows, 3);
  noise.by_bias = by_gyro_bias(problem, state);
  noise.with_path = s * s * problem.covariance.topLeftCorner(rows, rows);
  noise.with_path.noalias() += noise.with_bias * noise.by_bias.transpose();
  MatrixXd all = noise.with_path + problem.inertial_noise;
  const MatrixXd rest =
      noise.with_bias + noise.by_bias * problem.covariance.bottomRightCorner<3, 3>();
  all.noalias() += noise.by_bias * rest.transpose();
  noise.covariance.compute(all);
  if (noise.covariance.info() != Eigen::Success) return std::nullopt;
  return noise;
}

}  // namespace gpo
