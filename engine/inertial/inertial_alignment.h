// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/pose.h"
#include "engine/inertial/uncertain_poses.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Whether gravity and meters are found: after the initialization, from its poses; together with
/// it, so that accelerations move planes, poses and the gyroscope's bias, too; or not at all.
enum class Gravity { after, joint, off };

template <>
struct ChoiceKeys<Gravity> {
  static constexpr const char* name = "gravity";
  static constexpr std::array keys{"after", "joint", "off"};
};

/// What is known of an accelerometer and its place before anything is measured.
struct InertialOptions {
  double gravity_m_s2 = 9.81;
  double bias_sigma_m_s2 = 0.1;  ///< of the accelerometer, each axis
  /// Of the accelerations, white [m/s^2/sqrt(Hz)]; where they show more, that counts.
  double noise_density = 2e-3;
  double told_lever_sigma_m = 0.005;   ///< camera from sensor, each axis, where it is told
  double untold_lever_sigma_m = 0.05;  ///< where it is not: sensor and camera in one case
  double most_scale_sigma = 0.2;       ///< of a scale that is known [-]
};

/// Gravity and meters of poses up to scale, with one standard deviation. World = reference camera.
struct InertialAlignment {
  bool ok = false;
  std::string reason;                                      ///< why there is none, for people
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();  ///< down, in the world's axes
  Eigen::Matrix3d direction_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2], rank 2
  double gravity_sigma_deg = 0;                                    ///< root of its trace
  double scale = 0;            ///< meters per unit of the poses (plane distance)
  double log_scale_sigma = 0;  ///< infinite where nothing tells it [-]
  bool scale_known = false;
  std::string scale_reason;  ///< why it is not, for people
  /// Of the sensor in the world's axes, at the times of the poses that were taken.
  std::vector<Eigen::Vector3d> velocities_m_s;
  std::vector<std::int64_t> times_ns;
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();  ///< in the sensor's axes
  Eigen::Matrix3d accelerometer_bias_covariance = Eigen::Matrix3d::Zero();
  /// Squared residuals by what their covariances say, per degree of freedom. Above one, all
  /// covariances here are multiplied by it.
  double misfit = 0;
  bool joint = false;  ///< planes, poses and the gyroscope's bias were moved with it
  int iterations = 0;
  double milliseconds = 0;
};

/// What accelerations say of the poses that they were aligned with, over the rows of the poses'
/// covariance (engine/method.md, eq. 25): of anything x that is known together with them, and has
/// the covariance C with them, x - C gradient, and Cov(x) - C information C^T.
struct PosePull {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
};

struct PullingAlignment {
  InertialAlignment inertial;
  PosePull pull;  ///< empty where the alignment is not ok
};

/// Finds gravity, scale and velocities that make poses and accelerations agree (engine/method.md,
/// eq. 21 to 24). `T_body_camera` is the camera in the body's axes [m]; where it is not told,
/// or its translation is zero as loggers leave it, the translation is one more unknown.
InertialAlignment align_inertial(const UncertainPoses& poses,
                                 const Gyroscope& gyroscope,
                                 const std::optional<Pose>& T_body_camera,
                                 const InertialOptions& options = {});
/// The same, and what it says of the poses.
PullingAlignment align_and_pull(const UncertainPoses& poses,
                                const Gyroscope& gyroscope,
                                const std::optional<Pose>& T_body_camera,
                                const InertialOptions& options = {});

}  // namespace gpo
