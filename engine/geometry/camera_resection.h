// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <optional>
#include <span>

namespace gpo {

/// A camera pose estimated from 2D-3D correspondences.
struct Resection {
  Pose pose;
  double median_px;  ///< median reprojection error [px]
};

/// Returns the lowest minimum of SQPnP's algebraic cost (Terzakis & Lourakis, "A consistently fast
/// and globally optimal solution to the perspective-n-point problem", ECCV 2020) that descents from
/// eight starts reach, also for coplanar points. It need not be the global one. `seen` are
/// normalized coordinates K^-1 p, 2 x n, n >= 4. nullopt if no minimum has most points in front of
/// the camera.
std::optional<Pose> solve_sqpnp(const Eigen::Matrix3Xd& points_w, const Eigen::Matrix2Xd& seen);

/// Refines a pose by Gauss-Newton on the reprojection error. Each step uses the points within three
/// robust standard deviations (from the median error). Points and undistorted `pixels` have n
/// columns. nullopt if fewer than 4 points are in front of the camera.
std::optional<Resection> refine_pose(const Pose& start,
                                     const Eigen::Matrix3Xd& points_w,
                                     const Eigen::Matrix2Xd& pixels,
                                     const Eigen::Matrix3d& K);

/// Solves perspective-n-point without an initial pose: SQPnP, which unlike EPnP also handles points
/// near a plane, then `refine_pose`. n >= 4.
std::optional<Resection> resect_camera(const Eigen::Matrix3Xd& points_w,
                                       const Eigen::Matrix2Xd& pixels,
                                       const Eigen::Matrix3d& K);

/// Returns the pose with the smaller error: `before` refined, or another one without a start.
std::optional<Resection> follow_camera(const Pose& before,
                                       const Eigen::Matrix3Xd& points_w,
                                       const Eigen::Matrix2Xd& pixels,
                                       const Eigen::Matrix3d& K);

/// Triangulates a point by minimizing sum |x_i - pi(R_cwi (X - p_wci))|^2, Gauss-Newton from the
/// point nearest to all rays. `rays` are K^-1 p_i with third coordinate 1, 3 x n, one per camera.
/// nullopt if the rays do not determine the point or it is behind a camera.
std::optional<Eigen::Vector3d> triangulate(std::span<const Pose> cameras,
                                           const Eigen::Matrix3Xd& rays);

/// Returns the largest angle between the first camera's ray to the point and any other's [deg].
double parallax_deg(std::span<const Pose> cameras, const Eigen::Vector3d& point_w);

}  // namespace gpo
