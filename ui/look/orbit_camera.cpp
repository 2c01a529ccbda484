// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/orbit_camera.h"

#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace gpo {
namespace {

constexpr double kSteepest_deg = 89;
constexpr double kZoomStep = 6.0 / 5;

double half_tangent(const OrbitCamera& camera) {
  return std::tan(radians(camera.view_angle_deg) / 2);
}

/// Positions x of the eye along one axis of the view from which all points are within the slopes
/// -`before` and `after` of the forward direction: least + after z <= x <= most - before z.
struct Reach {
  double least, most, before, after;

  double forward() const { return (most - least) / (before + after); }
  double sideways(double z) const { return (least + after * z + most - before * z) / 2; }
};
Reach reach(std::span<const Eigen::Vector3d> points_v, int axis, double before, double after) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Reach result{-kInfinity, kInfinity, before, after};
  for (const Eigen::Vector3d& p : points_v) {
    result.least = std::max(result.least, p[axis] - after * p.z());
    result.most = std::min(result.most, p[axis] + before * p.z());
  }
  return result;
}

}  // namespace

Eigen::Matrix3d view_axes(const OrbitCamera& camera) {
  const Eigen::Vector3d heading =
      Eigen::AngleAxisd(radians(camera.yaw_deg), camera.up) * camera.front;
  const double pitch = radians(camera.pitch_deg);
  const Eigen::Vector3d forward = std::cos(pitch) * heading - std::sin(pitch) * camera.up;
  const Eigen::Vector3d right = forward.cross(camera.up).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return axes;
}

Eigen::Vector3d eye(const OrbitCamera& camera) {
  return camera.target - camera.distance * view_axes(camera).col(2);
}

OrbitCamera orbited(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, double height_px) {
  OrbitCamera result = camera;
  result.yaw_deg = std::remainder(camera.yaw_deg - 180 * drag_px.x() / height_px, 360.0);
  result.pitch_deg =
      std::clamp(camera.pitch_deg + 180 * drag_px.y() / height_px, -kSteepest_deg, kSteepest_deg);
  return result;
}

OrbitCamera panned(const OrbitCamera& camera, const Eigen::Vector2d& drag_px, double height_px) {
  const Eigen::Matrix3d axes = view_axes(camera);
  const double unit = 1 / pixels_per_unit(camera, height_px);
  OrbitCamera result = camera;
  result.target -= unit * (drag_px.x() * axes.col(0) + drag_px.y() * axes.col(1));
  return result;
}

OrbitCamera zoomed(const OrbitCamera& camera, double wheel_steps) {
  OrbitCamera result = camera;
  result.distance = std::clamp(camera.distance * std::pow(kZoomStep, -wheel_steps), 1e-3, 1e4);
  return result;
}

OrbitCamera fitted(const OrbitCamera& camera,
                   std::span<const Eigen::Vector3d> points,
                   double aspect,
                   const FitMargins& margins) {
  if (points.empty()) return camera;
  const Eigen::Matrix3d axes = view_axes(camera);
  std::vector<Eigen::Vector3d> points_v;
  double depth = 0;
  for (const Eigen::Vector3d& point : points) {
    points_v.push_back(axes.transpose() * point);
    depth += points_v.back().z() / static_cast<double>(points.size());
  }
  const double tangent = half_tangent(camera), wide = aspect * tangent;
  const Reach x = reach(points_v, 0, wide * (1 - margins.left), wide * (1 - margins.right));
  const Reach y = reach(points_v, 1, tangent * (1 - margins.top), tangent * (1 - margins.bottom));
  OrbitCamera result = camera;
  const double forward = std::min(x.forward(), y.forward());
  result.distance = std::max(depth - forward, 1e-3);
  result.target =
      axes * Eigen::Vector3d(x.sideways(forward), y.sideways(forward), forward + result.distance);
  return result;
}

std::optional<Eigen::Vector2d> on_screen(const OrbitCamera& camera,
                                         const Eigen::Vector3d& point,
                                         const ScreenRect& rect) {
  const Eigen::Vector3d p = view_axes(camera).transpose() * (point - eye(camera));
  if (p.z() <= 0) return std::nullopt;
  const double focal_px = rect.size.y() / 2 / half_tangent(camera);
  return (rect.size / 2 + focal_px * p.head<2>() / p.z()) + rect.min;
}

Eigen::Vector3d view_ray(const OrbitCamera& camera,
                         const Eigen::Vector2d& pixel,
                         const Eigen::Vector2d& view_size_px) {
  const double focal_px = view_size_px.y() / 2 / half_tangent(camera);
  return view_axes(camera) * ((pixel - view_size_px / 2) / focal_px).homogeneous();
}

std::optional<std::array<Eigen::Vector3d, 2>> in_front(const OrbitCamera& camera,
                                                       const Eigen::Vector3d& a,
                                                       const Eigen::Vector3d& b) {
  const Eigen::Vector3d forward = view_axes(camera).col(2), from = eye(camera);
  const double nearest = 1e-3 * camera.distance;
  const double depth_a = forward.dot(a - from), depth_b = forward.dot(b - from);
  if (depth_a < nearest && depth_b < nearest) return std::nullopt;
  const auto cut = [&] { return a + (nearest - depth_a) / (depth_b - depth_a) * (b - a); };
  return std::array<Eigen::Vector3d, 2>{depth_a < nearest ? cut() : a,
                                        depth_b < nearest ? cut() : b};
}

double pixels_per_unit(const OrbitCamera& camera, double height_px) {
  return height_px / 2 / half_tangent(camera) / camera.distance;
}

}  // namespace gpo
