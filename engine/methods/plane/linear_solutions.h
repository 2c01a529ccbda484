// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Solutions without iterations over a nonlinear cost: starts of the optimizations.
#include "engine/methods/plane/plane_motion.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Returns tau n^T of a frame, the rank-one part I - H' / lambda of its homography; not finite
/// without a homography.
Eigen::Matrix3d translation_times_normal(const Window& window, int frame);

/// Returns normal and translations from all homographies at once, without selecting decompositions:
/// I - H'_i / lambda_i = tau_i n^T with H'_i = R_wci K^-1 H_i1 K and lambda_i its middle singular
/// value; stacked over the frames, the matrix has rank one and n is its right singular vector
/// (engine/method.md, eq. 8). The sign is that of a visible plane. nullopt if a homography is
/// missing.
std::optional<PlaneMotion> closed_form_motion(const Window& window);

/// Returns tau of a frame for a given normal and the window's rotation, by linear least squares
/// (engine/method.md, eq. 9) over the frame's inliers, weighted to pixel errors in three rounds.
Eigen::Vector3d translation_given_normal(const Window& window,
                                         int frame,
                                         const Eigen::Vector3d& normal);

/// Returns the window's planes other than the main plane, each by linear least squares for given
/// cameras: [x_i]x R_ciw tau_i (m.x_1) = [x_i]x R_ciw x_1 over its tracks and the frames
/// (engine/method.md, eq. 3), weighted to pixels by a first solution. Omits planes that the motion
/// does not determine or that have most of their tracks behind the reference camera.
std::vector<OtherPlane> other_planes(const Window& window, const PlaneMotion& motion);

/// Returns the planes' indices in the window.
std::vector<int> numbers_of(const std::vector<OtherPlane>& planes);

/// Returns the twin of a motion: the other feasible decomposition of the homography with the
/// largest translation, and in the other frames the decompositions with a similar normal. Further
/// planes are omitted. nullopt if the homography with the largest translation has only one.
std::optional<PlaneMotion> twin_motion(const Window& window, const PlaneMotion& motion);

}  // namespace gpo
