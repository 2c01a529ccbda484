// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "ui/look/rect.h"

#include <Eigen/Core>

namespace gpo {

/// What a user looks at: the picture, times what fits it into the rectangle, around a point.
struct ImageZoom {
  double factor = 1;                                        ///< 1: all of it fits [-]
  Eigen::Vector2d center = Eigen::Vector2d::Constant(0.5);  ///< in the middle [0..1 of the picture]

  bool operator==(const ImageZoom&) const = default;
};

/// Picture <-> screen. The center of the top-left pixel is (0, 0) in the picture, so its top-left
/// corner is (-0.5, -0.5) and lies at `origin`.
struct ImageMapping {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< whole screen pixels
  double scale = 1;                                  ///< screen pixels a picture pixel
  /// Shown as the pinhole camera with the same intrinsics would see it; null: as recorded. Where
  /// the lens model ends the places are NaN.
  const Camera* undistorted = nullptr;
};
/// Refers to the camera where it is `undistorted`.
ImageMapping map_image(const Camera& camera,
                           const ScreenRect& rect,
                           const ImageZoom& zoom,
                           bool undistorted = false);
Eigen::Vector2d to_screen(const ImageMapping& mapping, const Eigen::Vector2d& image_px);
Eigen::Vector2d to_image(const ImageMapping& mapping, const Eigen::Vector2d& screen_px);

/// Zooms by `by`, within 1..64, such that what is under the pointer stays there.
ImageZoom zoom_about(const ImageZoom& zoom,
                       const Camera& camera,
                       const ScreenRect& rect,
                       const Eigen::Vector2d& pointer,
                       double by);
/// Moves the picture by so many screen pixels, its middle no further than its border.
ImageZoom pan(const ImageZoom& zoom,
                const Camera& camera,
                const ScreenRect& rect,
                const Eigen::Vector2d& by);

}  // namespace gpo
