// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <optional>

#include <Eigen/Core>

namespace gpo {

/// A camera's pose without a start, from points that it sees: the global minimum of SQPnP's cost
/// (Terzakis & Lourakis, "A consistently fast and globally optimal solution to the
/// perspective-n-point problem", ECCV 2020), also of points on a plane. `seen` are normalized
/// coordinates K^-1 p, one a point, n >= 4. Nothing where no minimum has the points in front of
/// the camera.
std::optional<Pose> pose_of_least_algebraic_error(const Eigen::Matrix3Xd& points_w,
                                                  const Eigen::Matrix2Xd& seen);

}  // namespace gpo
