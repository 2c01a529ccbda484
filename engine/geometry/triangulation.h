// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace gpo {

/// Least-squares point of several views: minimizes sum |x_i - pi(R_cwi (X - p_wci))|^2 by
/// Gauss-Newton from the point nearest to all rays. `rays` are K^-1 p_i with third coordinate 1,
/// 3 x n, one a camera. Nothing where the rays do not determine it or it is behind a camera.
std::optional<Eigen::Vector3d> triangulate(std::span<const Pose> cameras,
                                           const Eigen::Matrix3Xd& rays);

/// Largest angle between the first camera's ray to the point and any other's [deg].
double parallax_deg(std::span<const Pose> cameras, const Eigen::Vector3d& point_w);

}  // namespace gpo
