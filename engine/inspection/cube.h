// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/recording/recording.h"
#include "engine/window/window.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Where the virtual cube stands (engine/method.md, "The virtual cube"). Base edges along the
/// columns x and y of `axes`, which lie on the plane; column z is the plane's normal, towards the
/// camera; x cross y points away from the camera, as rows and columns of a picture do.
struct CubeAnchor {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< on the plane
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool on_board =
      false;        ///< origin is a corner of the base, on a chessboard; else the base's center
  double unit = 1;  ///< side of a chessboard square, else the plane's distance from the camera
};

/// The base's center where the ray of an undistorted pixel's direction meets the plane, x as far as
/// possible along the camera's x. Nothing where the ray misses the plane.
std::optional<CubeAnchor> anchor_on_plane(const Plane& plane_w,
                                          const Pose& camera,
                                          const Eigen::Vector3d& ray_c);

/// The board's first corner and axes, as seen along `corner_rays_c` (all corners, row by row) from
/// `camera`, carried onto the plane. Nothing where a ray misses the plane.
std::optional<CubeAnchor> anchor_on_board(const Plane& plane_w,
                                          const Pose& camera,
                                          std::span<const Eigen::Vector3d> corner_rays_c,
                                          const Board& board);

/// 0.2 of the plane's distance, or the whole number of chessboard squares nearest to that.
double default_cube_side(const CubeAnchor& anchor, double plane_distance = 1);

/// Corners: bit 0 of the index is x, bit 1 is y, bit 2 is z (4..7 are the top). A tower is several
/// sides high.
std::array<Eigen::Vector3d, 8> cube_corners(const CubeAnchor& anchor,
                                            double side,
                                            double height_sides = 1);

/// The cube's place on a plane, in the plane's world: on the recording's board, whose corners (row
/// by row) were seen at these raw pixels of the reference picture, or where there is none where the
/// ray to the inliers' centroid meets the plane. `reference` is the reference camera in that world.
/// Nothing where a ray misses the plane.
std::optional<CubeAnchor> place_cube(const Plane& plane_w,
                                     const Pose& reference,
                                     const Recording& recording,
                                     const Window& window,
                                     const std::vector<Eigen::Vector2d>& board_corners_raw_px);

}  // namespace gpo
