// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/scene/plane_grid.h"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Chi-square of 95 % for two and three degrees of freedom.
constexpr double kChiSquare2 = 5.991, kChiSquare3 = 7.815;

/// Three closed lines of an ellipsoid: its sections through two of its axes each.
using EllipsoidLines = std::array<std::vector<Eigen::Vector3d>, 3>;

/// Where a point is with 95 %, `enlarged` so many times about its estimate.
EllipsoidLines confidence_ellipsoid(const Eigen::Vector3d& center,
                                    const Eigen::Matrix3d& covariance,
                                    double enlarged);

/// The plane's normal as an arrow on the plane, with the ends of its head's lines.
struct NormalArrow {
  Eigen::Vector3d base, tip;
  std::array<Eigen::Vector3d, 4> head = {};
};
/// In the middle of that edge of the grid that is farthest from the cameras. The initialization is
/// ok.
NormalArrow normal_arrow(const Inspection& inspection, const PlaneGrid& grid);

/// The closed line around the arrow's tip within which it ends with 95 %: angles [rad], `enlarged`
/// so many times, at most a right angle.
std::vector<Eigen::Vector3d> confidence_rim(const NormalArrow& arrow,
                                            const Eigen::Matrix3d& normal_covariance,
                                            double enlarged);

}  // namespace gpo
