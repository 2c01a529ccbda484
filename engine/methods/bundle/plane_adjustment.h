// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/bundle/bundle_adjustment.h"
#include "engine/methods/common/watch.h"

namespace gpo {

/// Poses and points of a window, all points on one plane by parametrization: two unknowns a point.
struct PlaneBundle {
  std::vector<Pose> cameras;  ///< one a frame, the first one the identity
  Eigen::Vector3d normal;     ///< of the plane n.P + 1 = 0
  Eigen::Matrix2Xd pixels_1;  ///< 2 x points: where the reference camera sees them [px]
};

/// The same with its points' inverse depths rho = -n.x_1 written out.
Bundle free_bundle(const Eigen::Matrix3d& K, const PlaneBundle& bundle);

enum class PlaneNormal { free, held };

struct AdjustedPlaneBundle {
  PlaneBundle bundle;
  SolverReport solver;
};

/// Least reprojection error over all poses, the plane's normal unless it is held, and the points on
/// that plane, every observation one residual; the plane's distance 1 is the scale. 6m + 2n - 6
/// unknowns, two less where the normal is held. Observations behind a camera at the start make it
/// fail.
AdjustedPlaneBundle adjust_plane_bundle(const Eigen::Matrix3d& K,
                                        const PlaneBundle& start,
                                        std::span<const Observation> observations,
                                        PlaneNormal normal,
                                        const Watch& watch);

}  // namespace gpo
