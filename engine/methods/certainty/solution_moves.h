// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Displacements of a solution by errors of the gyroscope and the lens.
#include "engine/methods/certainty/sandwich.h"

#include <cstddef>
#include <span>
#include <vector>

namespace gpo {

/// Returns the displacements by each step of the gyroscope's random walk about each world axis;
/// empty if the gyroscope noise is not an unknown.
std::vector<SolutionMove> moves_by_gyro_noise(const Sandwich& sandwich);

/// Change of the points for one standard deviation of each lens parameter
/// (`Window::lens_moves_px`).
using LensMoves = std::span<const std::vector<Eigen::Matrix2Xd>>;

/// Returns the displacements by one standard deviation of each lens parameter.
std::vector<SolutionMove> moves_by_lens(const Sandwich& sandwich, LensMoves moves_px);

/// Adds the spread of the gyroscope noise, a random walk, if it is an unknown (engine/method.md,
/// eq. 14f).
void add_gyro_noise(const Sandwich& sandwich, Spread& spread);

struct JointParts {
  std::span<const SolutionMove> tracks;  ///< `moves_by_track`
  const Spread& observations;            ///< `spread_by_observation`
  std::span<const SolutionMove> others;  ///< by the gyroscope and the lens
  const SharedMatrix& shared;            ///< covariance of the shared unknowns by all errors
};

/// Returns the joint covariance of all camera centers but the first, the gyroscope bias if it is a
/// shared unknown, and the planes (`Uncertainty::joint_covariance`): the shrunk sum over tracks,
/// the sum over all other moves, and the rest of the shared unknowns' covariance.
Eigen::MatrixXd joint_covariance(const PlaneMotion& motion,
                                 const Bread& bread,
                                 const JointParts& parts);

}  // namespace gpo
