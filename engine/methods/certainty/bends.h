// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/certainty/sandwich.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/plane/plane_motion.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Returns the variation of each plane's normal over a surface that is not flat: a quadratic is
/// fitted to the tracks' heights above the plane, and this is the second moment of its slopes at
/// the tracks around their mean, over the plane's tangents [rad^2] (engine/method.md, eq. 14d).
/// Without a gyroscope it is fitted together with the motion. Relief, curved paper and lens errors
/// contribute. nullopt if the curvature is not significant. `sigma_px`: noise of a coordinate.
std::vector<std::optional<Eigen::Matrix2d>> bends_of(const SolvedPlanes& solved, double sigma_px);

/// The unknowns that all frames share, in the order of `Uncertainty::joint_covariance`: gyroscope,
/// then planes.
struct SharedMoves {
  SharedMatrix covariance;  ///< by noise
  Eigen::MatrixXd results;  ///< d(rows of the joint covariance) / d(these unknowns)
};

/// Widens the covariances of centers, poses, bias, time offset, row delay and distances as errors
/// that neighboring tracks share and bends widen the normal's variance by `ratio`: by the moves of
/// the shared unknowns, up to their priors (engine/method.md, eq. 14k). The joint covariance stays.
void widen_by_systematic_errors(const SolvedPlanes& solved,
                                double ratio,
                                const SharedMoves& shared,
                                Uncertainty& u);

/// Adds the variation of all normals over surfaces that are not flat.
void add_bends(const SolvedPlanes& solved, Uncertainty& u);

}  // namespace gpo
