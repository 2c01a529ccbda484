// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/initializers/common/initialization.h"
#include "engine/window/window.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A frame with fewer inliers than this fails the window; a homography alone takes four.
inline constexpr int kLeastInliers = 8;

/// Why no method should try: a frame has too few inliers, or rotations alone explain all frames (no
/// parallax), so that any plane would do. Nothing where the window may be tried.
std::optional<std::string> reason_not_to_try(const Window& window);

/// Why a solution is not one, though the solver ended: points behind a camera, or residuals far
/// above what the homographies leave (wrong minimum, or rotations that do not belong to the
/// pictures).
std::optional<std::string> reason_to_distrust(const Window& window,
                                              const Plane& plane,
                                              std::span<const Pose> cameras);

/// How a homography and the best rotation explain one frame's inliers.
struct FrameErrors {
  int inliers = 0;
  double homography_px = 0;       ///< median transfer error of the frame's homography
  double rotation_px = 0;         ///< the same of the best rotation
  double homography_squares = 0;  ///< summed over both coordinates [px^2]
  double rotation_squares = 0;    ///< [px^2]
};
FrameErrors frame_errors(const Window& window, int frame);

/// Reprojection errors of the inlier observations [px], the reference frame's left out; infinite
/// where the point falls behind the camera.
std::vector<double> reprojection_errors_px(const Window& window,
                                           const Plane& plane,
                                           std::span<const Pose> cameras);

/// The same for points that need not lie on a plane: each inlier observation of a map point, those
/// of the reference frame, too, as it does not fix a free point.
std::vector<double> reprojection_errors_px(const Window& window,
                                           std::span<const Pose> cameras,
                                           std::span<const MapPoint> points);

/// What the homographies leave: the median over the frames of an inlier's median transfer error
/// [px].
double homography_error_px(const Window& window);

/// Root mean square, 0 of nothing.
double root_mean_square(std::span<const double> values);

}  // namespace gpo
