// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"

#include <Eigen/Core>

namespace gpo {

/// A part of the screen, y down [screen px].
struct ScreenRect {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
};

/// The part of the image that a user looks at.
struct ImageZoom {
  double factor = 1;                                        ///< 1: the whole image fits [-]
  Eigen::Vector2d center = Eigen::Vector2d::Constant(0.5);  ///< in the middle [0..1 of the image]

  bool operator==(const ImageZoom&) const = default;
};

/// Maps between image and screen. The image's top-left corner, (-0.5, -0.5), is at `origin`.
struct ImageMapping {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< whole screen pixels
  double scale = 1;                                  ///< screen pixels per image pixel
  /// If set, the image is undistorted; points beyond the range of the lens model are NaN.
  const Camera* undistorted = nullptr;
};
ImageMapping map_image(const Camera& camera,
                       const ScreenRect& rect,
                       const ImageZoom& zoom,
                       bool undistorted = false);
Eigen::Vector2d to_screen(const ImageMapping& mapping, const Eigen::Vector2d& raw_px);
Eigen::Vector2d to_image(const ImageMapping& mapping, const Eigen::Vector2d& screen_px);

/// Multiplies the zoom by `by`, within 1..64, and keeps the point under the pointer in place.
ImageZoom zoom_about(const ImageZoom& zoom,
                     const Camera& camera,
                     const ScreenRect& rect,
                     const Eigen::Vector2d& pointer,
                     double by);
/// Moves the image by screen pixels, its center no further than its border.
ImageZoom pan(const ImageZoom& zoom,
              const Camera& camera,
              const ScreenRect& rect,
              const Eigen::Vector2d& by);

constexpr double kLargestNormalsZoom = 400;

/// The part of the disc of normals (`disc_from_normal`) that a user looks at.
struct NormalsZoom {
  double factor = 1;                                 ///< 1: the whole disc fits [-]
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< in the middle [on the disc]
};
/// Returns the nearest zoom that shows a part of the disc.
NormalsZoom within_limits(NormalsZoom zoom);

struct DiscMapping {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< center of the disc [screen px]
  double radius = 1;                                 ///< [screen px]

  Eigen::Vector2d to_screen(const Eigen::Vector2d& disc) const { return middle + radius * disc; }
  Eigen::Vector2d to_disc(const Eigen::Vector2d& screen) const {
    return (screen - middle) / radius;
  }
};
/// At zoom 1 the disc and its labels fit into the rectangle.
DiscMapping map_disc(const ScreenRect& rect, const NormalsZoom& zoom);

NormalsZoom zoom_about(const NormalsZoom& zoom,
                       const ScreenRect& rect,
                       const Eigen::Vector2d& pointer,
                       double by);
NormalsZoom pan(const NormalsZoom& zoom, const ScreenRect& rect, const Eigen::Vector2d& by);

}  // namespace gpo
