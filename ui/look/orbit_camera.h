// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace gpo {

/// Who looks at the scene: from a sphere around a target. A plain value.
struct OrbitCamera {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();     ///< unit
  Eigen::Vector3d front = Eigen::Vector3d::UnitX();  ///< unit, normal to `up`: where yaw 0 looks
  double yaw_deg = 0;                                ///< around `up`
  double pitch_deg = 30;                             ///< 90: from straight above; within ±89
  double distance = 1;                               ///< eye to target
  double view_angle_deg = 30;                        ///< vertical
};

/// Axes of the view in the world, as columns: right, down, forward.
Eigen::Matrix3d view_axes(const OrbitCamera& camera);
Eigen::Vector3d eye(const OrbitCamera& camera);

/// Mouse drags in pixels, y down: half a turn for a drag over the height of the view.
OrbitCamera orbited(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, double height_px);
/// What was grabbed at the target's depth follows the pointer.
OrbitCamera panned(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, double height_px);
/// Nearer by a sixth for each step of the wheel, farther for negative ones.
OrbitCamera zoomed(const OrbitCamera& camera, double wheel_steps);
/// Room around what is fitted, as shares of the view's half size.
struct FitMargins {
  double left = 0.08, right = 0.08, top = 0.08, bottom = 0.08;
};
/// Same direction, as near as it goes with all points in view and the margins around them. `aspect`
/// is width / height. Unchanged without points.
OrbitCamera fitted(const OrbitCamera& camera,
                   std::span<const Eigen::Vector3d> points,
                   double aspect,
                   const FitMargins& margins = {});

/// Pixel (y down, the view's top-left corner is (0, 0)) where a point appears; nothing behind the
/// eye.
std::optional<Eigen::Vector2d> view_pixel(const OrbitCamera& camera,
                                          const Eigen::Vector3d& point,
                                          const Eigen::Vector2d& view_size_px);

/// Through such a pixel, in the world, forward by one.
Eigen::Vector3d view_ray(const OrbitCamera& camera,
                         const Eigen::Vector2d& pixel,
                         const Eigen::Vector2d& view_size_px);

/// The part of a line that is in front of the eye, so that its ends have pixels.
std::optional<std::array<Eigen::Vector3d, 2>> in_front(const OrbitCamera& camera,
                                                       const Eigen::Vector3d& a,
                                                       const Eigen::Vector3d& b);

/// Pixels that a unit of length at the target's depth is long.
double pixels_a_unit(const OrbitCamera& camera, double height_px);

}  // namespace gpo
