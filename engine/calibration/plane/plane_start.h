// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_adjustment.h"
#include "engine/calibration/plane/plane_views.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A plane's points as one picture would show all of them, and the homographies from there to every
/// sight; undistorted pixels from the picture's middle.
struct PlaneMosaic {
  Eigen::Matrix2Xd points;             ///< NaN: not placed
  std::vector<Eigen::Matrix3d> H_i_m;  ///< one a sight; NaN: not placed
  int root = 0;                        ///< the sight in whose picture they are
};

/// From sight to sight, those that share most points first. `camera` undistorts.
PlaneMosaic plane_mosaic(const ObservedPlane& plane, const Camera& camera);

/// Normals that the plane may have in the mosaic's view, if the focal length is so much, the best
/// first, with how badly they do (0: perfectly; Triggs 1998): a homography from the plane, in
/// Euclidean coordinates, has two first columns that are orthogonal and of equal length.
struct NormalGuess {
  Eigen::Vector3d normal;
  double badness = 0;
};
std::vector<NormalGuess> normal_guesses(const PlaneMosaic& mosaic, double focal_px, int most);

/// Points and poses by the mosaic, of a plane with that normal. Nothing where it faces the wrong
/// way.
std::optional<AdjustedPlane> start_of(const PlaneMosaic& mosaic,
                                      double focal_px,
                                      const Eigen::Vector3d& normal);

}  // namespace gpo
