// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The closed line of the normals so far from one, on the disc.
std::vector<Eigen::Vector2d> circle_on_disc(const Eigen::Vector3d& normal, double radius_deg);
/// The closed line around a normal within which it is with 95 % by its covariance [rad^2].
std::vector<Eigen::Vector2d> confidence_on_disc(const Eigen::Vector3d& normal,
                                                const Eigen::Matrix3d& covariance);

}  // namespace gpo
