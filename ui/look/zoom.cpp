// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/zoom.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr double kLargestImageZoom = 64;
constexpr double kDiscMargin = 1.13;  // share of the radius that disc and labels take

Vector2d size_of(const Camera& camera) { return Vector2d(camera.width, camera.height); }

double fitting_scale(const Camera& camera, const ScreenRect& rect) {
  return std::max(rect.size.cwiseQuotient(size_of(camera)).minCoeff(), 1e-6);
}

}  // namespace

ImageMapping map_image(const Camera& camera,
                           const ScreenRect& rect,
                           const ImageZoom& zoom,
                           bool undistorted) {
  const double scale = fitting_scale(camera, rect) * zoom.factor;
  const Vector2d corner =
      rect.min + rect.size / 2 - scale * zoom.center.cwiseProduct(size_of(camera));
  return {corner.array().round(), scale, undistorted ? &camera : nullptr};
}

Vector2d to_screen(const ImageMapping& mapping, const Vector2d& raw_px) {
  const Vector2d shown_px =
      mapping.undistorted != nullptr ? undistort(*mapping.undistorted, raw_px) : raw_px;
  return mapping.origin + mapping.scale * (shown_px + Vector2d::Constant(0.5));
}

Vector2d to_image(const ImageMapping& mapping, const Vector2d& screen_px) {
  const Vector2d shown_px = (screen_px - mapping.origin) / mapping.scale - Vector2d::Constant(0.5);
  return mapping.undistorted != nullptr ? distort(*mapping.undistorted, shown_px) : shown_px;
}

ImageZoom zoom_about(const ImageZoom& zoom,
                       const Camera& camera,
                       const ScreenRect& rect,
                       const Vector2d& pointer,
                       double by) {
  ImageZoom result = zoom;
  result.factor = std::clamp(zoom.factor * by, 1.0, kLargestImageZoom);
  // center + (pointer - middle) / (scale size) is the same point before and after.
  const double fit = fitting_scale(camera, rect);
  const Vector2d from_middle =
      (pointer - rect.min - rect.size / 2).cwiseQuotient(fit * size_of(camera));
  result.center += from_middle * (1 / zoom.factor - 1 / result.factor);
  return pan(result, camera, rect, Vector2d::Zero());
}

ImageZoom pan(const ImageZoom& zoom,
                const Camera& camera,
                const ScreenRect& rect,
                const Vector2d& by) {
  ImageZoom result = zoom;
  const double scale = fitting_scale(camera, rect) * zoom.factor;
  result.center -= by.cwiseQuotient(scale * size_of(camera));
  result.center = result.center.cwiseMax(0.0).cwiseMin(1.0);
  if (result.factor <= 1) result.center.setConstant(0.5);
  return result;
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

NormalsZoom zoom_about(const NormalsZoom& zoom,
                       const ScreenRect& rect,
                       const Vector2d& pointer,
                       double by) {
  const Vector2d under = map_disc(rect, zoom).to_disc(pointer);
  NormalsZoom zoomed = zoom;
  zoomed.factor = std::clamp(zoom.factor * by, 1.0, kLargestNormalsZoom);
  const double radius = map_disc(rect, zoomed).radius;
  zoomed.center = under - (pointer - rect.min - rect.size / 2) / radius;
  return within_limits(zoomed);
}

NormalsZoom pan(const NormalsZoom& zoom, const ScreenRect& rect, const Vector2d& by) {
  NormalsZoom moved = zoom;
  moved.center -= by / map_disc(rect, zoom).radius;
  return within_limits(moved);
}

}  // namespace gpo
