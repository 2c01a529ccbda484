// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/scene/orbit_camera.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// 1, 2 or 5 times a power of ten, the greatest that is not longer.
double nice_length(double length);

/// Brings the truth into the estimate's world: by the aligned paths where they determine it, else
/// by the reference camera and a scale (the alignment's, or the plane's true distance). Nothing
/// where neither is known.
std::optional<Similarity> estimate_from_truth(const Inspection& inspection);

/// The true camera of a frame of the window in the estimate's world.
std::optional<Pose> true_camera(const Inspection& inspection,
                                const Similarity& T_est_true,
                                int frame_in_window);

/// The camera's center, the corners of its picture at that depth (top-left, top-right,
/// bottom-right, bottom-left), and the tip of a mark above the upper edge.
std::array<Eigen::Vector3d, 6> frustum(const Camera& camera, const Pose& pose, double depth);

/// How deep the frusta are drawn, so that they neither hide each other nor vanish.
double frustum_depth(const Inspection& inspection);

/// Of the world's axes, as they are drawn.
double axes_length(const Inspection& inspection);

/// Every so many frames a frustum is drawn, so that some ten make the path.
int frustum_stride(const Inspection& inspection);

/// A finite part of a plane, in cells.
struct PlaneGrid {
  Eigen::Vector3d origin;        ///< on the plane
  Eigen::Vector3d x, y;          ///< unit, along the plane
  Eigen::Vector3d normal;        ///< unit, towards the cameras
  double cell = 0.1;             ///< a nice length
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

/// Where the cameras (also the true ones), the plane and the cube are: what a view must contain.
std::vector<Eigen::Vector3d> scene_extent(const Inspection& inspection, double cube_side);

/// From behind the reference camera, above and beside it, everything in view.
OrbitCamera default_scene_camera(const Inspection& inspection, double cube_side, double aspect);

}  // namespace gpo
