// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/zoom.h"

#include <array>
#include <optional>
#include <span>

namespace gpo {

/// Camera on a sphere around a target.
struct OrbitCamera {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();     ///< unit
  Eigen::Vector3d front = Eigen::Vector3d::UnitX();  ///< unit, normal to `up`: direction of yaw 0
  double yaw_deg = 0;                                ///< around `up`
  double pitch_deg = 30;                             ///< 90: from straight above; within ±89
  double distance = 1;                               ///< eye to target
  double view_angle_deg = 30;                        ///< vertical

  bool operator==(const OrbitCamera&) const = default;
};

/// Returns the axes of the view in the world, as columns: right, down, forward.
Eigen::Matrix3d view_axes(const OrbitCamera& camera);
Eigen::Vector3d eye(const OrbitCamera& camera);

/// Rotates by a mouse drag in pixels, y down: half a turn for a drag over the view's height.
OrbitCamera orbited(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, double height_px);
/// Moves such that points at the target's depth follow the pointer.
OrbitCamera panned(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, double height_px);
/// Divides the distance by 1.2 per step of the wheel.
OrbitCamera zoomed(const OrbitCamera& camera, double wheel_steps);
/// Free margins, as shares of the view's half size.
struct FitMargins {
  double left = 0.08, right = 0.08, top = 0.08, bottom = 0.08;
};
/// Moves as close as all points and the margins allow. `aspect` is width / height.
OrbitCamera fitted(const OrbitCamera& camera,
                   std::span<const Eigen::Vector3d> points,
                   double aspect,
                   const FitMargins& margins = {});

/// Returns the place of a point on the screen, for a view that fills the rectangle; nullopt if it
/// is behind the eye.
std::optional<Eigen::Vector2d> on_screen(const OrbitCamera& camera,
                                         const Eigen::Vector3d& point,
                                         const ScreenRect& rect);

/// Returns the ray through a pixel (y down, the view's top-left corner is (0, 0)), in the world, of
/// length 1 along the view's axis.
Eigen::Vector3d view_ray(const OrbitCamera& camera,
                         const Eigen::Vector2d& pixel,
                         const Eigen::Vector2d& view_size_px);

/// Clips a line to the part in front of the eye; nullopt if there is none.
std::optional<std::array<Eigen::Vector3d, 2>> in_front(const OrbitCamera& camera,
                                                       const Eigen::Vector3d& a,
                                                       const Eigen::Vector3d& b);

/// Returns the length on the screen of a unit at the target's depth [px].
double pixels_per_unit(const OrbitCamera& camera, double height_px);

}  // namespace gpo
