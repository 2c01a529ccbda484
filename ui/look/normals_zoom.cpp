// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/normals_zoom.h"

#include <algorithm>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr double kMargin = 1.13;  // of the disc: room for the labels around it

}  // namespace

NormalsZoom within_limits(NormalsZoom zoom) {
  zoom.factor = std::clamp(zoom.factor, 1.0, kLargestNormalsZoom);
  if (zoom.center.norm() > 1) zoom.center.normalize();
  if (zoom.factor == 1) zoom.center.setZero();
  return zoom;
}

DiscMapping map_disc(const ScreenRect& rect, const NormalsZoom& zoom) {
  DiscMapping mapping;
  mapping.radius = zoom.factor * rect.size.minCoeff() / 2 / kMargin;
  mapping.middle = rect.min + rect.size / 2 - mapping.radius * zoom.center;
  return mapping;
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
