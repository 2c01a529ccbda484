// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"

#include <array>
#include <optional>

#include <Eigen/Core>

namespace gpo {

/// Where the virtual cube stands (method.md, "The virtual cube"). Base edges along the columns x
/// and y of `axes`, which lie on the plane; column z is the plane's normal, towards the camera.
struct CubeAnchor {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< on the plane
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool centered = true;          ///< origin is the base's center, else one of its corners
  std::optional<double> square;  ///< side of a chessboard square, where it stands on a board
};

/// 0.2 of the plane's distance, or the whole number of chessboard squares nearest to it.
double default_cube_side(const CubeAnchor& anchor, double plane_distance = 1);

/// Corners: bit 0 of the index is x, bit 1 is y, bit 2 is z (4..7 are the top).
std::array<Eigen::Vector3d, 8> cube_corners(const CubeAnchor& anchor, double side);

}  // namespace gpo
