// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/certainty/sandwich.h"
#include "engine/methods/plane/plane_motion.h"

#include <span>

#include <Eigen/Core>

namespace gpo {

/// Covariance of all camera centers but the first at once, stacked, of the gyroscope's bias where
/// that is among what the frames share, and of the planes: what each move does, and what else is
/// not known of what is shared (all of it is `shared`).
Eigen::MatrixXd joint_covariance(const PlaneMotion& motion,
                                 const Bread& bread,
                                 std::span<const SolutionMove> moves,
                                 const SharedMatrix& shared);

}  // namespace gpo
