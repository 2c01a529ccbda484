// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/rect.h"

#include <Eigen/Core>

namespace gpo {

constexpr double kLargestNormalsZoom = 400;

/// What a user looks at of the disc of normals (`disc_from_normal`), times what fits it.
struct NormalsZoom {
  double factor = 1;                                 ///< 1: all of it fits [-]
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< in the middle [on the disc]
};
/// The nearest one that shows something.
NormalsZoom within_limits(NormalsZoom zoom);

/// Disc <-> screen.
struct DiscMapping {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of the disc [screen px]
  double radius = 1;                                 ///< [screen px]

  Eigen::Vector2d to_screen(const Eigen::Vector2d& disc) const { return middle + radius * disc; }
  Eigen::Vector2d to_disc(const Eigen::Vector2d& screen) const {
    return (screen - middle) / radius;
  }
};
/// The disc and its labels fit into the rectangle.
DiscMapping map_disc(const ScreenRect& rect, const NormalsZoom& zoom);

/// Such that what is under the pointer stays there.
NormalsZoom zoom_about(const NormalsZoom& zoom,
                       const ScreenRect& rect,
                       const Eigen::Vector2d& pointer,
                       double by);
/// Moves the disc by so many screen pixels.
NormalsZoom pan(const NormalsZoom& zoom, const ScreenRect& rect, const Eigen::Vector2d& by);

}  // namespace gpo
