// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_observations.h"
#include "engine/window/window.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A plane beside the leading one, m.P + 1 = 0.
struct OtherPlane {
  int number = 0;                                 ///< in the window
  Eigen::Vector3d m = -Eigen::Vector3d::UnitZ();  ///< n / d [1 / distance of the leading plane]
};

/// The unknowns of an optimization over planes: world = reference camera, the leading plane's
/// distance 1. Of the
/// two solutions with the same pictures, (n, tau) and (-n, -tau), `facing` is the one that is seen.
struct PlaneMotion {
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  std::vector<OtherPlane> others = {};  ///< further planes that are seen from these cameras
  std::vector<Eigen::Vector3d> tau;     ///< one a frame, -p_wc
  std::vector<Eigen::Matrix3d> R_wc;    ///< one a frame
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();  ///< where the rotations depend on it
  double time_offset_s = 0;  ///< added to the gyroscope's own, where they depend on it
  /// One a frame: its rotation is what the gyroscope's turns into, times exp(this); empty where the
  /// gyroscope's noise is no unknown.
  std::vector<Eigen::Vector3d> gyro_noise_rad = {};
};

/// The window's rotations, all translations zero, the normal along z: where the paper starts.
PlaneMotion resting(const Window& window);
/// A solution's plane and cameras.
PlaneMotion motion_of(const Plane& plane, std::span<const Pose> cameras);

/// With the sign that puts most inliers in front of the reference camera.
PlaneMotion facing(const Window& window, PlaneMotion motion);
std::vector<Pose> cameras_of(const PlaneMotion& motion);

/// What a gyroscope's rotation R_wc of a frame turns into with the motion's bias and time offset is
/// R_wc exp(this), to first order.
Eigen::Vector3d gyro_correction_rad(const Window& window, int frame, const PlaneMotion& motion);

/// R_wc of a frame from the gyroscope with the motion's bias, time offset and noise.
Eigen::Matrix3d gyro_rotation(const Window& window, int frame, const PlaneMotion& motion);
/// Standard deviation of that noise, each axis: the rates' white noise, integrated from the
/// reference frame on [rad].
double gyro_noise_sigma_rad(const Window& window, int frame);

/// Where a frame's errors are linearized.
FrameState frame_state(const PlaneObservations& observations, const PlaneMotion& motion, int frame);
/// The same for another plane's, m = n / d of it in the leading plane's place; the tangents are
/// those of n times the length of m.
FrameState frame_state(const PlaneObservations& observations,
                       const PlaneMotion& motion,
                       int frame,
                       const Eigen::Vector3d& m);

/// A normal after a step over its `normal_tangents`.
Eigen::Vector3d moved_normal(const Eigen::Vector3d& normal, const Eigen::Vector2d& u_rad);

}  // namespace gpo
