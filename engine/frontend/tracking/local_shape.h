// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/patch.h"
#include "engine/geometry/camera.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A template's pixels at left, middle and right of its first, middle and last row; 2 x 9, by row.
using Nodes = Eigen::Matrix<double, 2, 9>;

/// Tracks around a track in the reference frame, whose motion determines how its template deforms.
/// All places are undistorted.
struct Neighborhood {
  std::vector<int> neighbors;  ///< the nearest first
  /// 1, x, y, x^2, x y, y^2 of each from the template's middle, in the reference frame [100 px].
  Eigen::Matrix<double, 6, Eigen::Dynamic> monomials;
  Nodes nodes_px;  ///< in the reference frame, from the template's middle
};

/// Returns the neighborhood of each track. `raw_px` is 2 x tracks, in the reference frame;
/// templates reach `half` pixels around the nearest whole pixel.
std::vector<Neighborhood> make_neighborhoods(const Camera& camera,
                                             const Eigen::Matrix2Xd& raw_px,
                                             int half);

/// Returns the nodes of a template of `half` pixels around a whole raw pixel, undistorted [px].
Nodes patch_nodes(const Camera& camera, const Eigen::Vector2d& middle_px, int half);

/// Returns the warp in raw pixels of a template with these nodes under a homography of undistorted
/// pixels. Returns nullopt if the lens cannot show a node, or the template would be mirrored.
std::optional<Warp> warp_by(const Camera& camera,
                            const Eigen::Matrix3d& H,
                            const Nodes& nodes_px,
                            int half);

/// Returns the warp with its center unchanged and the shape that a homography and the lens give the
/// template. The homography is fitted robustly to the warped corners of the template and to the
/// neighbors that agree with it (engine/method.md, 15b). `undistorted_px` has all tracks in the
/// same image, 2 x tracks, NaN: lost. Returns the warp unchanged if the lens cannot show it.
Warp shaped(const Camera& camera,
            const Warp& warp,
            const Eigen::Matrix2Xd& undistorted_px,
            int half,
            const Neighborhood& neighborhood);

}  // namespace gpo
