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

/// Corners of a cube's edges and faces, in the order of `cube_corners`: each bit of an index is an
/// axis. The first face is the base; the corners of a face are in turn.
// clang-format off
inline constexpr std::array<std::array<int, 2>, 12> kCubeEdges = {
    {{0, 1}, {0, 2}, {0, 4}, {1, 3}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 6}, {5, 7}, {6, 7}}};
// clang-format on
inline constexpr std::array<std::array<int, 4>, 6> kCubeFaces = {
    {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};

using Outline = std::vector<Eigen::Vector2d>;

/// An edge as a polyline in the image; empty if it is invisible.
struct CubeEdge {
  std::array<int, 2> corners;
  bool base;    ///< of the square on the plane
  bool hidden;  ///< behind the cube's own faces
  Outline raw_px;
};

/// A face's outline in the image; empty unless all of it is in front of the camera.
struct CubeFace {
  std::array<int, 4> corners;
  bool base;
  bool facing;  ///< its outside is towards the camera
  Outline raw_px;
};

struct CubeImage {
  std::vector<CubeEdge> edges;  ///< 12
  std::vector<CubeFace> faces;  ///< 6
};

/// Projects the cube with these corners (`cube_corners`) into the camera at `pose`. Straight edges
/// are bent by the lens and clipped in front of the camera.
CubeImage cube_in_image(const Camera& camera,
                            const Pose& pose,
                            const std::array<Eigen::Vector3d, 8>& corners_w);

/// Size of the virtual cube.
struct CubeSize {
  double side;              ///< [unit of the estimate]
  double height_sides = 1;  ///< height in sides; more than 1: a tower
};

/// Projects the virtual cube into a frame of the window by the frame's estimated pose; nullopt if
/// the initialization failed.
std::optional<CubeImage> estimated_cube(const Inspection& inspection, int frame, CubeSize size);

/// The same cube on the true plane, by the true pose; nullopt if one of them is unknown.
std::optional<CubeImage> true_cube(const Inspection& inspection, int frame, CubeSize size);

/// Returns the cube with its image distance from a reference multiplied by `times`. Edges and faces
/// that are not complete in both are empty.
CubeImage exaggerated(const CubeImage& cube, const CubeImage& reference, double times);

/// Returns outlines on the estimated plane around the cube's base, in which the cube blocks light,
/// from the outermost inwards. Empty unless all are in front of the camera.
std::vector<Outline> contact_shadow(const Inspection& inspection, int frame, double side);

/// Returns the horizon in the image, bent by the lens: one or several pieces, or none. `up_w` is
/// the up direction in the world, of any length.
std::vector<Outline> horizon_in_image(const Camera& camera,
                                        const Pose& pose,
                                        const Eigen::Vector3d& up_w);

/// Observation of a track, and its prediction from plane, poses and the reference frame [raw px].
struct ResidualVector {
  int track;
  Eigen::Vector2d observed_px;
  Eigen::Vector2d predicted_px;
};

/// Returns the residuals of the inliers of a frame of the window, through
/// H_i1 = K R_ciw (I - tau_i n^T) K^-1. Empty if the initialization failed.
std::vector<ResidualVector> residual_vectors(const Inspection& inspection, int frame);

/// Intersects the ray through a pixel of a frame of the window with a plane, in the estimate's
/// world, in which it is also a ray of the reference camera. nullopt if the frame has no pose or
/// the ray misses the plane.
std::optional<Eigen::Vector3d> point_on_plane(const Inspection& inspection,
                                              int frame,
                                              const Eigen::Vector2d& raw_px,
                                              const Plane& plane);

using Triangle = std::array<Eigen::Vector2d, 3>;

/// Parts of an image that are nearer to the camera than the cube.
struct Occluder {
  int plane = 0;  ///< its number in the window
  std::vector<Triangle> triangles_raw_px;
};

/// Returns the planes of the window, except the leading one, that hide the cube in a frame. A plane
/// is assumed to be visible in Delaunay triangles of its tracks that are small and contain no other
/// track. It hides the cube if all of the cube seen through them is behind it.
std::vector<Occluder> occluders(const Inspection& inspection,
                                int frame,
                                const std::array<Eigen::Vector3d, 8>& cube_corners_w);

}  // namespace gpo
