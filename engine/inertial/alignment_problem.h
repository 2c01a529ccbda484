// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inertial/preintegration.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace gpo {

/// Relation of poses and inertial measurements with gravity and scale (engine/method.md, eq. 21).
/// For each frame but the first [m]:
///   r_k = s c_k - (R_k - R_1) t - v t_k - g t_k^2 / 2 - P_k(b_g, b_a)
struct AlignmentProblem {
  std::vector<InertialFrame> path;  ///< one per frame
  Eigen::VectorXd centers;          ///< c_k, stacked [plane distance]
  Eigen::MatrixXd covariance;       ///< centers, then gyroscope's bias
  Eigen::MatrixXd inertial_noise;   ///< covariance of P_k [m^2]
  Eigen::Vector3d lever_m;          ///< prior of the camera in sensor axes
  double lever_sigma_m = 0;
  double bias_sigma_m_s2 = 0;
};

/// The unknowns; a step is (v, two `normal_tangents` of g, log s, b_a, t).
struct AlignmentState {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< sensor at the first frame [m/s]
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();   ///< fixed length [m/s^2]
  double log_scale = 0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();   ///< accelerometer [m/s^2]
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< [m]
};
inline constexpr int kAlignmentUnknowns = 12;
inline constexpr int kScaleUnknown = 5;

AlignmentState stepped(const AlignmentState& state, const Eigen::VectorXd& step);

Eigen::VectorXd residuals(const AlignmentProblem& problem, const AlignmentState& state);
/// Derivatives of the residuals by a step; `meters` is s c_k in the derivative by log s.
Eigen::MatrixXd jacobian(const AlignmentProblem& problem,
                         const AlignmentState& state,
                         const Eigen::VectorXd& meters);
/// Derivatives of the residuals by the gyroscope's bias, rows x 3, without its second-order effect
/// on the accelerometer's bias.
Eigen::MatrixXd by_gyro_bias(const AlignmentProblem& problem, const AlignmentState& state);

/// Returns the changes of the residuals by a gravity that is longer by a share, and by a force that
/// is along each of the sensor's axes, which hardly rotates between two frames. `between`:
/// intervals of the problem's path.
std::vector<Eigen::VectorXd> changes_by_scales(const AlignmentProblem& problem,
                                               const AlignmentState& state,
                                               std::span<const Preintegration> between,
                                               double gravity_share,
                                               double force_share);

/// Solves linear equations for scale, gravity and velocity (Qin and Shen 2018), first with free
/// gravity, then with its known length.
AlignmentState linear_start(const AlignmentProblem& problem, double gravity_m_s2);

/// Returns the velocities of the sensor in world axes, one per frame [m/s].
std::vector<Eigen::Vector3d> velocities(const AlignmentProblem& problem,
                                        const AlignmentState& state);

/// Noise of the residuals at a scale.
struct ResidualNoise {
  double log_scale = 0;
  Eigen::LLT<Eigen::MatrixXd> covariance;  ///< covariance of the residuals [m^2]
  /// Covariance of s c_k with the residuals: its own plus with_bias by_bias^T.
  Eigen::MatrixXd with_path;
  Eigen::MatrixXd with_bias;  ///< covariance of s c_k with the gyroscope's bias
  Eigen::MatrixXd by_bias;    ///< `by_gyro_bias`
};
/// nullopt if the covariance is not positive definite.
std::optional<ResidualNoise> residual_noise(const AlignmentProblem& problem,
                                            const AlignmentState& state);

}  // namespace gpo
