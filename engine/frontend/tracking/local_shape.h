// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/patch.h"
#include "engine/geometry/camera.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

struct ShapeOptions {
  int neighbors = 60;       ///< of a track, the nearest in the reference frame [-]
  double start_px = 3;      ///< by the look's own shape, one that far off counts a quarter [px]
  double agreement_px = 1;  ///< the same by the shape that neighbors tell [px]
};

/// A look's pixels at left, middle and right of its first, middle and last row; 2 x 9, row by row.
using Nodes = Eigen::Matrix<double, 2, 9>;

/// Those around a track in the reference frame, whose motion tells how its look deforms. All places
/// are undistorted.
struct Neighborhood {
  std::vector<int> neighbors;  ///< the nearest first
  /// 1, x, y, x^2, x y, y^2 of each from the look's middle, in the reference frame [100 px].
  Eigen::Matrix<double, 6, Eigen::Dynamic> monomials;
  Nodes nodes_px;  ///< of the look, in the reference frame, from its middle
};

/// One a track. `raw_px` is 2 x tracks, in the reference frame; their looks are `half` pixels
/// around the nearest whole pixel.
std::vector<Neighborhood> make_neighborhoods(const Camera& camera,
                                             const Eigen::Matrix2Xd& raw_px,
                                             int half,
                                             const ShapeOptions& options = {});

/// The nodes of a look of `half` pixels around a whole raw pixel, undistorted [px].
Nodes look_nodes(const Camera& camera, const Eigen::Vector2d& middle_px, int half);

/// Where a homography of undistorted pixels puts a look that has these nodes, in raw pixels.
/// Nothing where the lens has no such place, or the look would be turned over.
std::optional<Warp> warp_by(const Camera& camera,
                            const Eigen::Matrix3d& H,
                            const Nodes& nodes_px,
                            int half);

/// The warp's center, around it the shape that a homography and the lens give a look: the one
/// through the look's corners as the warp has them and through those neighbors that agree with it,
/// robustly (engine/method.md, 15b). `undistorted_px` are all tracks' places in the same picture, 2
/// x tracks, NaN: lost. As it is where the lens has no such place.
Warp shaped(const Camera& camera,
            const Warp& warp,
            const Eigen::Matrix2Xd& undistorted_px,
            int half,
            const Neighborhood& neighborhood,
            const ShapeOptions& options = {});

}  // namespace gpo
