// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/window/frame_errors.h"
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

/// Inlier tracks that the plane puts behind the reference camera, ascending.
std::vector<int> beyond_horizon(const Window& window, const Plane& plane);

/// A method's plane and cameras as its result, `ok`; or a failure where they are to be distrusted,
/// with the solver's report and the candidates.
Initialization trusted(const Window& window, Initialization result);

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

/// Noise of one coordinate [px], of what a fit leaves: sqrt(squares / (residuals - unknowns)); the
/// root of the squares where there are no more residuals than unknowns.
double noise_px(double summed_squares, double residuals, double unknowns);

}  // namespace gpo
