// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/window/window.h"

#include <optional>

#include <Eigen/Core>

namespace gpo {

/// The plane through those of a map's points, 3 x n, that the reference camera sees within 2 deg of
/// an inlier track of its frame, by RANSAC with a fixed seed; in the map's world. The map may hold
/// more than this window and more than one plane. Nothing for fewer than 10 such points.
std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window);

}  // namespace gpo
