// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"

#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace gpo {

struct PlaneFitOptions {
  double threshold =
      0.02;              ///< distance of an inlier from the plane [median distance of the points]
  int iterations = 500;  ///< 3-point samples [-]
  std::uint64_t seed = 1;
};

/// The plane of most points by 3-point RANSAC, refined on its inliers (total least squares), its
/// normal towards the origin. 3 x n; nothing for fewer than 3 points or where all lie on a line.
std::optional<Plane> fit_plane(const Eigen::Matrix3Xd& points, const PlaneFitOptions& options = {});

}  // namespace gpo
