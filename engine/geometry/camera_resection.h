// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <optional>
#include <span>

namespace gpo {

struct Resection {
  Pose pose;
  double median_px;  ///< median reprojection error [px]
};

/// SQPnP (Terzakis & Lourakis, ECCV 2020), n >= 4, `seen` K^-1 p. nullopt if points are behind.
std::optional<Pose> solve_sqpnp(const Eigen::Matrix3Xd& points_w, const Eigen::Matrix2Xd& seen);

/// Gauss-Newton on points within three sigmas; nullopt for fewer than 4 in front of the camera.
std::optional<Resection> refine_pose(const Pose& start,
                                     const Eigen::Matrix3Xd& points_w,
                                     const Eigen::Matrix2Xd& pixels,
                                     const Eigen::Matrix3d& K);

/// SQPnP, which also handles points near a plane, then `refine_pose`. n >= 4.
std::optional<Resection> resect_camera(const Eigen::Matrix3Xd& points_w,
                                       const Eigen::Matrix2Xd& pixels,
                                       const Eigen::Matrix3d& K);

/// Minimizes the reprojection error; `rays` are K^-1 p, 3 x n. nullopt if undetermined or behind.
std::optional<Eigen::Vector3d> triangulate(std::span<const Pose> cameras,
                                           const Eigen::Matrix3Xd& rays);

/// Returns the largest angle between the first camera's ray to the point and any other's [deg].
double parallax_deg(std::span<const Pose> cameras, const Eigen::Vector3d& point_w);

}  // namespace gpo
