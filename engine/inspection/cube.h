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

/// Place of the virtual cube (engine/method.md, "The virtual cube"). Base edges are along the
/// columns x and y of `axes`, on the plane; column z is the plane's normal, towards the camera; x
/// cross y points away from the camera, as for rows and columns of an image.
struct CubeAnchor {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< on the plane
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool on_board = false;  ///< origin is a base corner, on a chessboard; else the base's center
  double unit = 1;  ///< side of a chessboard square, else the plane's distance from the camera
};

/// Centers the base where a ray of the camera meets the plane, with x as near as possible to the
/// camera's x. Returns nullopt if the ray misses the plane.
std::optional<CubeAnchor> anchor_on_plane(const Plane& plane_w,
                                          const Pose& camera,
                                          const Eigen::Vector3d& ray_c);

/// Projects the board's first corner and axes onto the plane along `corner_rays_c` (all corners,
/// row by row) of `camera`. Returns nullopt if a ray misses the plane.
std::optional<CubeAnchor> anchor_on_board(const Plane& plane_w,
                                          const Pose& camera,
                                          std::span<const Eigen::Vector3d> corner_rays_c,
                                          const Board& board);

/// Returns 0.2 of the plane's distance, or the nearest whole number of chessboard squares.
double default_cube_side(const CubeAnchor& anchor, double plane_distance = 1);

/// Returns the corners: bit 0 of the index is x, bit 1 is y, bit 2 is z (4..7 are the top). A tower
/// is several sides high.
std::array<Eigen::Vector3d, 8> cube_corners(const CubeAnchor& anchor,
                                            double side,
                                            double height_sides = 1);

/// Places the cube on a plane, in the plane's world: on the recording's board, seen in the
/// reference image at these raw pixels (row by row), or without a board where the ray to the
/// inliers' centroid meets the plane. `reference` is the reference camera in that world. Returns
/// nullopt if a ray misses the plane.
std::optional<CubeAnchor> place_cube(const Plane& plane_w,
                                     const Pose& reference,
                                     const Recording& recording,
                                     const Window& window,
                                     const std::vector<Eigen::Vector2d>& board_corners_raw_px);

}  // namespace gpo
