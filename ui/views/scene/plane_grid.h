// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <array>
#include <optional>

#include <Eigen/Core>

namespace gpo {

/// 1, 2 or 5 times a power of ten, the greatest that is not longer.
double nice_length(double length);

/// A finite part of a plane, in cells.
struct PlaneGrid {
  Eigen::Vector3d origin;        ///< on the plane
  Eigen::Vector3d x, y;          ///< unit, along the plane
  Eigen::Vector3d normal;        ///< unit, towards the cameras
  double cell = 0.1;             ///< a nice length, in meters where they are known
  std::array<int, 2> low, high;  ///< cells from the origin along x and y

  Eigen::Vector3d at(double i, double j) const { return origin + cell * (i * x + j * y); }
};

/// The part of the estimated plane around the map points and the cube. The initialization is ok.
PlaneGrid plane_grid(const Inspection& inspection, double cube_side);

/// Border of the true plane in the estimate's world: what lies across from the estimate's grid,
/// half a cell wider, so that a tilt shows. Nothing where the true plane is unknown.
std::optional<std::array<Eigen::Vector3d, 4>> true_plane_border(const Inspection& inspection,
                                                                const Similarity& T_est_true,
                                                                const PlaneGrid& grid);

}  // namespace gpo
