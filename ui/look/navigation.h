// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace gpo {

using Eigen::Vector2d, Eigen::Vector3d;

/// A part of the screen, y down [screen px].
struct ScreenRect {
  Vector2d min = Vector2d::Zero();
  Vector2d size = Vector2d::Zero();
};

struct ImageZoom {
  double factor = 1;                          ///< 1: the whole image fits [-]
  Vector2d center = Vector2d::Constant(0.5);  ///< in the middle [0..1 of the shown image]

  bool operator==(const ImageZoom&) const = default;
};

/// An image as a view shows it: turned clockwise from how the sensor recorded it.
struct ShownImage {
  ShownImage(const Camera& camera, int quarter_turns = 0)
      : camera(camera), quarter_turns(quarter_turns) {}

  const Camera& camera;
  int quarter_turns;  ///< 0 to 3

  Vector2d size() const;  ///< [px] width and height as shown
};

/// Maps between image and screen. The top-left corner of the shown image is at `origin`.
struct ImageMapping {
  Vector2d origin = Vector2d::Zero();    ///< whole screen pixels
  double scale = 1;                      ///< screen pixels per image pixel
  Vector2d raw_size = Vector2d::Ones();  ///< [px] of the recorded image
  int quarter_turns = 0;                 ///< see `ShownImage`
  /// If set, the image is undistorted; points beyond the range of the lens model are NaN.
  const Camera* undistorted = nullptr;

  Vector2d end() const;  ///< bottom-right corner of the shown image [screen px]
};
ImageMapping map_image(const ShownImage& image,
                       const ScreenRect& rect,
                       const ImageZoom& zoom,
                       bool undistorted = false);
Vector2d to_screen(const ImageMapping& mapping, const Vector2d& raw_px);
Vector2d to_image(const ImageMapping& mapping, const Vector2d& screen_px);

/// Multiplies the zoom by `by`, within 1..64, and keeps the point under the pointer in place.
ImageZoom zoom_about(ImageZoom zoom,
                     const ShownImage& image,
                     const ScreenRect& rect,
                     const Vector2d& pointer,
                     double by);
/// Moves the image by screen pixels, its center no further than its border.
ImageZoom pan(ImageZoom zoom, const ShownImage& image, const ScreenRect& rect, const Vector2d& by);

constexpr double kLargestNormalsZoom = 400;

/// The part of the disc of normals (`disc_from_normal`) that a user looks at.
struct NormalsZoom {
  double factor = 1;                   ///< 1: the whole disc fits [-]
  Vector2d center = Vector2d::Zero();  ///< in the middle [on the disc]
};
/// Returns the nearest zoom that shows a part of the disc.
NormalsZoom within_limits(NormalsZoom zoom);

struct DiscMapping {
  Vector2d middle = Vector2d::Zero();  ///< center of the disc [screen px]
  double radius = 1;                   ///< [screen px]

  Vector2d to_screen(const Vector2d& disc) const { return middle + radius * disc; }
  Vector2d to_disc(const Vector2d& screen) const { return (screen - middle) / radius; }
};
/// At zoom 1 the disc and its labels fit into the rectangle.
DiscMapping map_disc(const ScreenRect& rect, const NormalsZoom& zoom);

NormalsZoom zoom_about(NormalsZoom zoom,
                       const ScreenRect& rect,
                       const Vector2d& pointer,
                       double by);
NormalsZoom pan(NormalsZoom zoom, const ScreenRect& rect, const Vector2d& by);

/// Camera on a sphere around a target.
struct OrbitCamera {
  Vector3d target = Vector3d::Zero();
  Vector3d up = Vector3d::UnitZ();     ///< unit
  Vector3d front = Vector3d::UnitX();  ///< unit, normal to `up`: direction of yaw 0
  double yaw_deg = 0;                  ///< around `up`
  double pitch_deg = 30;               ///< 90: from straight above; within ±89
  double distance = 1;                 ///< eye to target
  double view_angle_deg = 30;          ///< vertical

  bool operator==(const OrbitCamera&) const = default;
};

/// Returns the axes of the view in the world, as columns: right, down, forward.
Eigen::Matrix3d view_axes(const OrbitCamera& camera);
Vector3d eye(const OrbitCamera& camera);

/// Rotates by a mouse drag in pixels, y down: half a turn for a drag over the view's height.
OrbitCamera orbited(OrbitCamera camera, const Vector2d& drag_px, double height_px);
/// Moves such that points at the target's depth follow the pointer.
OrbitCamera panned(OrbitCamera camera, const Vector2d& drag_px, double height_px);
/// Divides the distance by 1.2 per step of the wheel.
OrbitCamera zoomed(OrbitCamera camera, double wheel_steps);
/// Free margins, as shares of the view's half size.
struct FitMargins {
  double left = 0.08, right = 0.08, top = 0.08, bottom = 0.08;
};
/// Moves as close as all points and the margins allow. `aspect` is width / height.
OrbitCamera fitted(OrbitCamera camera,
                   std::span<const Vector3d> points,
                   double aspect,
                   const FitMargins& margins = {});

/// Returns a point's place on the screen, in a view of this rectangle; nullopt behind the eye.
std::optional<Vector2d> on_screen(const OrbitCamera& camera,
                                  const Vector3d& point,
                                  const ScreenRect& rect);

/// Returns the ray through a pixel (y down, top-left corner (0, 0)), in the world, of depth 1.
Vector3d view_ray(const OrbitCamera& camera, const Vector2d& pixel, const Vector2d& view_size_px);

/// Clips a line to the part in front of the eye; nullopt if there is none.
std::optional<std::array<Vector3d, 2>> in_front(const OrbitCamera& camera,
                                                const Vector3d& a,
                                                const Vector3d& b);

/// Returns the length on the screen of a unit at the target's depth [px].
double pixels_per_unit(const OrbitCamera& camera, double height_px);

}  // namespace gpo
