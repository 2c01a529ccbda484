// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inertial/inertial_path.h"
#include "engine/inertial/uncertain_poses.h"

#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace gpo {

/// What poses and inertial measurements say of gravity and scale (engine/method.md, eq. 21): of
/// each frame but the first, [m],
///   r_k = s c_k - (R_k - R_1) t - v t_k - g t_k^2 / 2 - P_k(b_g, b_a)
struct AlignmentProblem {
  std::vector<InertialFrame> path;  ///< one a frame
  Eigen::VectorXd centers;          ///< c_k, stacked [plane distance]
  Eigen::MatrixXd covariance;       ///< of the centers, then of the gyroscope's bias
  Eigen::MatrixXd inertial_noise;   ///< covariance of P_k [m^2]
  Eigen::Vector3d lever_m;          ///< camera in the sensor's axes, as it is told
  double lever_sigma_m = 0;
  double bias_sigma_m_s2 = 0;
};

/// The unknowns; a step over them is (v, two `normal_tangents` of g, log s, b_a, t).
struct AlignmentState {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the sensor at the first frame [m/s]
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();   ///< of fixed length [m/s^2]
  double log_scale = 0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();   ///< of the accelerometer [m/s^2]
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< [m]
};
inline constexpr int kAlignmentUnknowns = 12;
inline constexpr int kScaleUnknown = 5;

/// A state after a step; gravity turns.
AlignmentState stepped(const AlignmentState& state, const Eigen::VectorXd& step);

Eigen::VectorXd residuals(const AlignmentProblem& problem, const AlignmentState& state);
/// Derivatives of the residuals by a step; the scale's with the path `meters` in place of s c_k.
Eigen::MatrixXd jacobian(const AlignmentProblem& problem,
                         const AlignmentState& state,
                         const Eigen::VectorXd& meters);
/// Derivatives of the residuals by the gyroscope's bias, rows x 3. Without what it does to the
/// accelerometer's bias, which is of second order.
Eigen::MatrixXd by_gyro_bias(const AlignmentProblem& problem, const AlignmentState& state);

/// Scale, gravity and velocity from linear equations (as Qin and Shen 2018 do): gravity free, then
/// of its known length.
AlignmentState linear_start(const AlignmentProblem& problem, double gravity_m_s2);

/// How wrong the residuals are at a scale.
struct ResidualNoise {
  double log_scale = 0;                    ///< where it was taken
  Eigen::LLT<Eigen::MatrixXd> covariance;  ///< of the residuals [m^2]
  /// Of the errors of s c_k with those of the residuals: theirs, plus with_bias by_bias^T.
  Eigen::MatrixXd with_path;
  Eigen::MatrixXd with_bias;  ///< of s c_k with the gyroscope's bias
  Eigen::MatrixXd by_bias;    ///< `by_gyro_bias`
};
/// Nothing where the covariance is none.
std::optional<ResidualNoise> residual_noise(const AlignmentProblem& problem,
                                            const AlignmentState& state);

}  // namespace gpo
