// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/inspection/inspection.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// An edge as a polyline in the picture; empty where it cannot be seen at all.
struct CubeEdge {
  std::array<int, 2> corners;  ///< as `cube_corners` counts them
  bool base;                   ///< of the square on the plane
  bool hidden;                 ///< behind the cube's own faces
  std::vector<Eigen::Vector2d> raw_px;
};

/// A face's outline in the picture; empty where it is not wholly in front of the camera.
struct CubeFace {
  std::array<int, 4> corners;  ///< around the face
  bool base;
  bool facing;  ///< its outside is towards the camera
  std::vector<Eigen::Vector2d> raw_px;
};

struct CubeImage {
  std::vector<CubeEdge> edges;  ///< 12
  std::vector<CubeFace> faces;  ///< 6
};

/// The cube with these corners (`cube_corners`) as the camera at `pose` sees it: straight edges
/// bend through the lens, what is behind the camera is cut off.
CubeImage cube_in_image(const Camera& camera,
                            const Pose& pose,
                            const std::array<Eigen::Vector3d, 8>& corners_w);

/// The virtual cube of this side [unit of the estimate] in a frame of the window, by the frame's
/// estimated pose. Nothing where the initialization failed.
std::optional<CubeImage> estimated_cube(const Inspection& inspection,
                                          int frame_in_window,
                                          double side,
                                          double height_sides = 1);

/// The same cube on the true plane, by the true pose. Nothing where one of them is not known.
std::optional<CubeImage> true_cube(const Inspection& inspection,
                                     int frame_in_window,
                                     double side,
                                     double height_sides = 1);

/// A cube whose distance in the picture from a reference is so many times what it is. Edges and
/// faces that only one of them shows whole are empty.
CubeImage exaggerated(const CubeImage& cube, const CubeImage& reference, double times);

/// Outlines on the estimated plane around the cube's base, each a little further out, the outermost
/// first: where the cube keeps light off. None where one of them is not in front of the camera.
std::vector<std::vector<Eigen::Vector2d>> contact_shadow(const Inspection& inspection,
                                                         int frame_in_window,
                                                         double side);

/// Where the camera sees what is level with it, bent by its lens; what is outside of the picture is
/// left out, so that there may be several pieces, or none. `up_w` of any length, in the world.
std::vector<std::vector<Eigen::Vector2d>> horizon_in_image(const Camera& camera,
                                                             const Pose& pose,
                                                             const Eigen::Vector3d& up_w);

/// Where a track was seen, and where plane and poses put what the reference frame saw [raw px].
struct ResidualVector {
  int track;
  Eigen::Vector2d observed_px;
  Eigen::Vector2d predicted_px;
};

/// Of the inliers of a frame of the window, through H_i1 = K R_ciw (I - tau_i n^T) K^-1. Empty
/// where the initialization failed.
std::vector<ResidualVector> residual_vectors(const Inspection& inspection, int frame_in_window);

/// Where a pixel of a frame of the window shows a plane, in the estimate's world: also the ray of
/// the reference camera to there. Nothing where the frame has no pose, or the pixel does not show
/// it.
std::optional<Eigen::Vector3d> point_on_plane(const Inspection& inspection,
                                              int frame_in_window,
                                              const Eigen::Vector2d& raw_px,
                                              const Plane& plane);

}  // namespace gpo
