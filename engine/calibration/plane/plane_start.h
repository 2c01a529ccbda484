// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_adjustment.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A plane's points in one image, and the homographies from there to all views. Undistorted pixels
/// relative to the image center.
struct PlaneMosaic {
  Eigen::Matrix2Xd points;             ///< NaN for points without a place
  std::vector<Eigen::Matrix3d> H_i_m;  ///< one a view; NaN for views without a place
};

/// Chains views, those with most points in common first. `camera` undistorts.
PlaneMosaic plane_mosaic(const ObservedPlane& plane, const Camera& camera);

/// Likely normals of the plane in the mosaic's view for a focal length, at most `most`, best first:
/// the first two columns of homographies from the plane, in Euclidean coordinates, are orthogonal
/// and of equal length (Triggs 1998).
std::vector<Eigen::Vector3d> likely_normals(const PlaneMosaic& mosaic, double focal_px, int most);

/// Points and poses of a plane with that normal by the mosaic; nullopt if it faces away.
std::optional<AdjustedPlane> start_of(const PlaneMosaic& mosaic,
                                      double focal_px,
                                      const Eigen::Vector3d& normal);

}  // namespace gpo
