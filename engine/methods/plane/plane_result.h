// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/plane/plane_motion.h"

#include <span>
#include <vector>

namespace gpo {

/// Returns map points without triangulation (engine/method.md, eq. 12): each inlier observation is
/// intersected with the plane, and a point is the mean over its frames. Inlier tracks only; in the
/// world of the poses. `cameras`: those of the first frames, which alone count.
std::vector<MapPoint> lift_to_plane(const Window& window,
                                    const Plane& plane,
                                    std::span<const Pose> cameras);

/// Returns the motion over all planes of a result, the main plane first.
PlaneMotion motion_of(const Initialization& result);

/// Returns plane and cameras of a motion.
RefusedSolution solution_of(const PlaneMotion& motion);

/// Returns H_i1 = K R_ciw (I - tau_i n^T) K^-1, undistorted, by the pose of camera i.
Eigen::Matrix3d homography_of(const Window& window, const Pose& pose, const Plane& plane);

/// Adds map points and RMS error to a result over a plane; a failure if it is not to be trusted.
Initialization with_map_points(const Window& window, Initialization result);

/// Returns the visible one of the two solutions with its cameras and map points; a failure if it is
/// not to be trusted.
Initialization make_result(const Window& window,
                           const PlaneMotion& motion,
                           const SolverReport& solver);

}  // namespace gpo
