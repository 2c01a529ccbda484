// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A window fails if a frame has fewer inliers; four would determine a homography.
inline constexpr int kLeastInliers = 8;

/// Returns why no method should try the window: a frame has too few inliers, or rotations alone
/// explain all frames (no parallax), so that any plane would fit. nullopt if it may be tried. Every
/// method calls it first. Throws InputError if lists of the window differ in size, if it has no
/// frame, or if K is not finite.
std::optional<std::string> reason_not_to_try(const Window& window);

/// Returns the inlier tracks that the plane puts behind the reference camera, ascending.
std::vector<int> beyond_horizon(const Window& window, const Plane& plane);

/// Returns the largest median residual with which a solution is trusted [px].
double most_residual_px(const Window& window);

/// Returns the plane and cameras as an `ok` result; a failure if points are behind a camera or the
/// residuals are far above those of the homographies (wrong minimum or wrong rotations).
Initialization trusted(const Window& window, Initialization result);

/// Returns the reprojection errors of the inlier observations without the reference frame [px];
/// infinite behind the camera.
std::vector<double> reprojection_errors_px(const Window& window,
                                           const Plane& plane,
                                           std::span<const Pose> cameras);

/// Returns the same for points that need not be on a plane, including the reference frame.
std::vector<double> reprojection_errors_px(const Window& window,
                                           std::span<const Pose> cameras,
                                           std::span<const MapPoint> points);

/// Triangulates an inlier track that at least two of the given cameras (one entry per frame) see.
std::optional<Eigen::Vector3d> triangulated_track(const Window& window,
                                                  std::span<const std::optional<Pose>> given,
                                                  int track);
/// Does the same for all inlier tracks.
std::vector<MapPoint> triangulated(const Window& window,
                                   std::span<const std::optional<Pose>> given);

/// Sets `transfer_rms_px` and `reprojection_rms_px` of a result. Points behind a camera do not
/// count.
void set_fit_errors(const Window& window, Initialization& result);

/// Returns the noise of one coordinate sqrt(squares / (residuals - unknowns)) [px]; the root of the
/// squares if there are no more residuals than unknowns.
double noise_px(double summed_squares, double residuals, double unknowns);

/// A method whose result another one refines.
struct StartMethod {
  const char* title;  ///< for people
  Initialization (*initialize)(const Window& window, const Watch& watch);
};

/// Refines `start`, which is `ok`.
using Refinement = Initialization (*)(const Window& window,
                                      const Initialization& start,
                                      const Watch& watch);

/// Returns the refined start; if the start failed, a failure with its title and reason.
Initialization refined_start(const Window& window,
                             const StartMethod& start,
                             Refinement refine,
                             const Watch& watch);

}  // namespace gpo
