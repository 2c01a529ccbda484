// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/methods/residuals/point_view.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <ceres/ceres.h>

namespace gpo {

/// A camera as the solver sees it: the unit quaternion of R_wc (x y z w) and p_wc. Tangent: 3
/// of the rotation, 3 of the position.
using PoseBlock = std::array<double, 7>;

std::vector<PoseBlock> pose_blocks(std::span<const Pose> cameras);
Pose pose_of(const PoseBlock& block);

/// The residual p - p_observed, and where `d_pose` is not null its derivative by the camera's
/// block, 2 x 7, row by row.
void write_residual(const PointView& view,
                    const Eigen::Vector2d& observed,
                    double* residual,
                    double* d_pose);

/// Adds the cameras as unknowns of group 1, the first one held; that of `scale_frame`, where given,
/// keeps its distance from the world's origin.
void add_pose_blocks(std::span<PoseBlock> cameras,
                     std::optional<int> scale_frame,
                     ceres::Problem& problem,
                     ceres::ParameterBlockOrdering& ordering);

}  // namespace gpo
