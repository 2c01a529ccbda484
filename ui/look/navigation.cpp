// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/navigation.h"

#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace gpo {
namespace {

constexpr double kLargestImageZoom = 64;
constexpr double kDiscMargin = 1.13;  // share of the radius that disc and labels take

Vector2d turned_size(const Vector2d& size, int quarter_turns) {
  return quarter_turns % 2 == 0 ? size : size.reverse().eval();
}

/// Turns a point clockwise with the image; both are measured from the image's top-left corner.
Vector2d turned(const Vector2d& from_corner, const Vector2d& size, int quarter_turns) {
  if (quarter_turns == 0) return from_corner;
  const Vector2d once(size.y() - from_corner.y(), from_corner.x());
  return turned(once, size.reverse(), quarter_turns - 1);
}

double fitting_scale(const ShownImage& image, const ScreenRect& rect) {
  return std::max(rect.size.cwiseQuotient(image.size()).minCoeff(), 1e-6);
}

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
Reach reach(std::span<const Vector3d> points_v, int axis, double before, double after) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Reach result{-kInfinity, kInfinity, before, after};
  for (const Vector3d& p : points_v) {
    result.least = std::max(result.least, p[axis] - after * p.z());
    result.most = std::min(result.most, p[axis] + before * p.z());
  }
  return result;
}

}  // namespace

Vector2d ShownImage::size() const {
  return turned_size(Vector2d(camera.width, camera.height), quarter_turns);
}

Vector2d ImageMapping::end() const { return origin + scale * turned_size(raw_size, quarter_turns); }

ImageMapping map_image(const ShownImage& image,
                       const ScreenRect& rect,
                       const ImageZoom& zoom,
                       bool undistorted) {
  const double scale = fitting_scale(image, rect) * zoom.factor;
  const Vector2d at = rect.min + rect.size / 2 - scale * zoom.center.cwiseProduct(image.size());
  return {.origin = at.array().round(),
          .scale = scale,
          .raw_size = Vector2d(image.camera.width, image.camera.height),
          .quarter_turns = image.quarter_turns,
          .undistorted = undistorted ? &image.camera : nullptr};
}

Vector2d to_screen(const ImageMapping& mapping, const Vector2d& raw_px) {
  const Vector2d pixel =
      mapping.undistorted != nullptr ? undistort(*mapping.undistorted, raw_px) : raw_px;
  const Vector2d from_corner = pixel + Vector2d::Constant(0.5);
  return mapping.origin +
         mapping.scale * turned(from_corner, mapping.raw_size, mapping.quarter_turns);
}

Vector2d to_image(const ImageMapping& mapping, const Vector2d& screen_px) {
  const Vector2d shown = (screen_px - mapping.origin) / mapping.scale;
  const int back = (4 - mapping.quarter_turns) % 4;
  const Vector2d pixel = turned(shown, turned_size(mapping.raw_size, mapping.quarter_turns), back) -
                         Vector2d::Constant(0.5);
  return mapping.undistorted != nullptr ? distort(*mapping.undistorted, pixel) : pixel;
}

ImageZoom zoom_about(ImageZoom zoom,
                     const ShownImage& image,
                     const ScreenRect& rect,
                     const Vector2d& pointer,
                     double by) {
  const double before = zoom.factor;
  zoom.factor = std::clamp(zoom.factor * by, 1.0, kLargestImageZoom);
  // center + (pointer - middle) / (scale size) is the same point before and after.
  const double fit = fitting_scale(image, rect);
  const Vector2d offset = (pointer - rect.min - rect.size / 2).cwiseQuotient(fit * image.size());
  zoom.center += offset * (1 / before - 1 / zoom.factor);
  return pan(zoom, image, rect, Vector2d::Zero());
}

ImageZoom pan(ImageZoom zoom, const ShownImage& image, const ScreenRect& rect, const Vector2d& by) {
  zoom.center -= by.cwiseQuotient(fitting_scale(image, rect) * zoom.factor * image.size());
  zoom.center = zoom.center.cwiseMax(0.0).cwiseMin(1.0);
  if (zoom.factor <= 1) zoom.center.setConstant(0.5);
  return zoom;
}

NormalsZoom within_limits(NormalsZoom zoom) {
  zoom.factor = std::clamp(zoom.factor, 1.0, kLargestNormalsZoom);
  if (zoom.center.norm() > 1) zoom.center.normalize();
  if (zoom.factor == 1) zoom.center.setZero();
  return zoom;
}

DiscMapping map_disc(const ScreenRect& rect, const NormalsZoom& zoom) {
  const double radius = zoom.factor * rect.size.minCoeff() / 2 / kDiscMargin;
  return {rect.min + rect.size / 2 - radius * zoom.center, radius};
}

NormalsZoom zoom_about(NormalsZoom zoom,
                       const ScreenRect& rect,
                       const Vector2d& pointer,
                       double by) {
  const Vector2d under = map_disc(rect, zoom).to_disc(pointer);
  zoom.factor = std::clamp(zoom.factor * by, 1.0, kLargestNormalsZoom);
  zoom.center = under - (pointer - rect.min - rect.size / 2) / map_disc(rect, zoom).radius;
  return within_limits(zoom);
}

NormalsZoom pan(NormalsZoom zoom, const ScreenRect& rect, const Vector2d& by) {
  zoom.center -= by / map_disc(rect, zoom).radius;
  return within_limits(zoom);
}

Eigen::Matrix3d view_axes(const OrbitCamera& camera) {
  const Vector3d heading = Eigen::AngleAxisd(radians(camera.yaw_deg), camera.up) * camera.front;
  const double pitch = radians(camera.pitch_deg);
  const Vector3d forward = std::cos(pitch) * heading - std::sin(pitch) * camera.up;
  const Vector3d right = forward.cross(camera.up).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return axes;
}

Vector3d eye(const OrbitCamera& camera) {
  return camera.target - camera.distance * view_axes(camera).col(2);
}

OrbitCamera orbited(OrbitCamera camera, const Vector2d& drag_px, double height_px) {
  camera.yaw_deg = std::remainder(camera.yaw_deg - 180 * drag_px.x() / height_px, 360.0);
  camera.pitch_deg =
      std::clamp(camera.pitch_deg + 180 * drag_px.y() / height_px, -kSteepest_deg, kSteepest_deg);
  return camera;
}

OrbitCamera panned(OrbitCamera camera, const Vector2d& drag_px, double height_px) {
  const Eigen::Matrix3d axes = view_axes(camera);
  const double unit = 1 / pixels_per_unit(camera, height_px);
  camera.target -= unit * (drag_px.x() * axes.col(0) + drag_px.y() * axes.col(1));
  return camera;
}

OrbitCamera zoomed(OrbitCamera camera, double wheel_steps) {
  camera.distance = std::clamp(camera.distance * std::pow(kZoomStep, -wheel_steps), 1e-3, 1e4);
  return camera;
}

OrbitCamera fitted(OrbitCamera camera,
                   std::span<const Vector3d> points,
                   double aspect,
                   const FitMargins& margins) {
  if (points.empty()) return camera;
  const Eigen::Matrix3d axes = view_axes(camera);
  std::vector<Vector3d> points_v;
  double depth = 0;
  for (const Vector3d& point : points) {
    points_v.push_back(axes.transpose() * point);
    depth += points_v.back().z() / static_cast<double>(points.size());
  }
  const double tangent = half_tangent(camera), wide = aspect * tangent;
  const Reach x = reach(points_v, 0, wide * (1 - margins.left), wide * (1 - margins.right));
  const Reach y = reach(points_v, 1, tangent * (1 - margins.top), tangent * (1 - margins.bottom));
  const double ahead = std::min(x.forward(), y.forward());
  camera.distance = std::max(depth - ahead, 1e-3);
  camera.target = axes * Vector3d(x.sideways(ahead), y.sideways(ahead), ahead + camera.distance);
  return camera;
}

std::optional<Vector2d> on_screen(const OrbitCamera& camera,
                                  const Vector3d& point,
                                  const ScreenRect& rect) {
  const Vector3d p = view_axes(camera).transpose() * (point - eye(camera));
  if (p.z() <= 0) return std::nullopt;
  const double focal_px = rect.size.y() / 2 / half_tangent(camera);
  return (rect.size / 2 + focal_px * p.head<2>() / p.z()) + rect.min;
}

Vector3d view_ray(const OrbitCamera& camera, const Vector2d& pixel, const Vector2d& view_size_px) {
  const double focal_px = view_size_px.y() / 2 / half_tangent(camera);
  return view_axes(camera) * ((pixel - view_size_px / 2) / focal_px).homogeneous();
}

std::optional<std::array<Vector3d, 2>> in_front(const OrbitCamera& camera,
                                                const Vector3d& a,
                                                const Vector3d& b) {
  const Vector3d forward = view_axes(camera).col(2), from = eye(camera);
  const double nearest = 1e-3 * camera.distance;
  const double depth_a = forward.dot(a - from), depth_b = forward.dot(b - from);
  if (depth_a < nearest && depth_b < nearest) return std::nullopt;
  const auto cut = [&] { return a + (nearest - depth_a) / (depth_b - depth_a) * (b - a); };
  return std::array<Vector3d, 2>{depth_a < nearest ? cut() : a, depth_b < nearest ? cut() : b};
}

double pixels_per_unit(const OrbitCamera& camera, double height_px) {
  return height_px / 2 / half_tangent(camera) / camera.distance;
}

}  // namespace gpo
