// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// When gravity and metric scale are estimated: after the initialization, from its poses; jointly,
/// so that accelerations also change planes, poses and the gyroscope's bias; or never.
enum class Gravity { after, joint, off };

template <>
struct ChoiceKeys<Gravity> : NamedKeys<"gravity", "after", "joint", "off"> {};

/// Covers an uncalibrated sensor: the bias of the one of EuRoC is 0.5 m/s^2 long.
inline constexpr double kAccelerometerBiasSigma_m_s2 = 0.3;

/// Priors of gravity, an accelerometer and its position.
struct InertialOptions {
  double gravity_m_s2 = 9.81;
  double gravity_sigma = 0.003;       ///< its length, without latitude and height [-]
  double scale_factor_sigma = 0.005;  ///< accelerometer, each axis [-]
  double bias_sigma_m_s2 = kAccelerometerBiasSigma_m_s2;  ///< accelerometer, each axis
  double noise_density = 2e-3;               ///< least noise of the accelerations [m/s^2/sqrt(Hz)]
  double calibrated_lever_sigma_m = 0.005;   ///< camera from sensor, each axis, if it is calibrated
  double uncalibrated_lever_sigma_m = 0.05;  ///< if it is not: sensor and camera in one case
  double most_scale_sigma = 0.2;             ///< largest uncertainty of a known scale [-]
};

/// Gravity and metric scale of poses up to scale, with one standard deviation. World = reference
/// camera.
struct InertialAlignment {
  bool ok = false;
  std::string reason;                                              ///< why it is not
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();          ///< down, world axes
  Eigen::Matrix3d direction_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2], rank 2
  double gravity_sigma_deg = 0;                                    ///< root of its trace
  double scale = 0;            ///< meters per unit of the poses (plane distance)
  double log_scale_sigma = 0;  ///< infinite if not determined [-]
  bool scale_known = false;
  std::string scale_reason = {};  ///< why it is not
  /// Velocities of the sensor in world axes, at `times_ns` of the aligned poses.
  std::vector<Eigen::Vector3d> velocities_m_s = {};
  std::vector<std::int64_t> times_ns = {};
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();  ///< sensor axes
  Eigen::Matrix3d accelerometer_bias_covariance = Eigen::Matrix3d::Zero();
  /// Squared residuals relative to their covariances, per degree of freedom. If above one, all
  /// covariances here are multiplied by it.
  double misfit = 0;
  bool joint = false;  ///< whether planes, poses and the gyroscope's bias changed with it
  int iterations = 0;
  double milliseconds = 0;
};

/// Poses up to scale, with their covariance.
struct UncertainPoses {
  std::vector<Pose> cameras;  ///< one per frame; the first one is the world [plane distance]
  std::vector<std::int64_t> times_ns = {};  ///< one per frame, camera clock
  /// Covariance of the centers of all frames but the first, stacked, then of the gyroscope's bias
  /// if it was estimated with them (3 more rows). Empty if unknown.
  Eigen::MatrixXd covariance;
  std::optional<Eigen::Vector3d> bias_rad_s = {};  ///< gyroscope bias of these rotations
  double time_offset_correction_s = 0;             ///< added to that of the gyroscope's clock
  /// Rows of `covariance` in the result's joint covariance; empty if that is missing.
  std::vector<int> joint_rows = {};

  Eigen::Index center_rows() const { return 3 * (static_cast<Eigen::Index>(cameras.size()) - 1); }
  bool has_bias_covariance() const { return covariance.rows() > center_rows(); }
};

/// Returns the poses of a result that is ok, at most of every second, third, ... frame: more than
/// 60 hardly improve an alignment, whose time grows with their cube.
UncertainPoses uncertain_poses(const Window& window, const Initialization& result);

/// Returns the first `count` poses with their covariance.
UncertainPoses first_poses(const UncertainPoses& poses, int count);

/// Correction of poses by the accelerations, over the rows of the poses' covariance
/// (engine/method.md, eq. 25). Any x that has the covariance C with the poses becomes
/// x - C gradient, and Cov(x) becomes Cov(x) - C information C^T.
struct PosePull {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
};

/// Estimates gravity, scale and velocities for which poses and accelerations agree
/// (engine/method.md, eq. 21 to 24). `T_body_camera` is the camera in body axes [m]. If it is
/// missing or has a zero translation, as loggers leave it, the translation is one more unknown.
/// Also computes `pull` if the result is ok.
InertialAlignment align_inertial(const UncertainPoses& poses,
                                 const Gyroscope& gyroscope,
                                 const std::optional<Pose>& T_body_camera,
                                 const InertialOptions& options = {},
                                 PosePull* pull = nullptr);

/// Number of poses, from the first one on, that determine the scale, by bisection; nullopt if all
/// of them do not. The poses are those of the whole window, so a live window may take longer.
std::optional<int> poses_that_determine_scale(const UncertainPoses& poses,
                                              const Gyroscope& gyroscope,
                                              const std::optional<Pose>& T_body_camera,
                                              const InertialOptions& options = {});

}  // namespace gpo
