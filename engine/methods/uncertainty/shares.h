// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Displacements of a solution by errors of the gyroscope, the lens and the readout.
#include "engine/methods/common/initialization.h"
#include "engine/methods/uncertainty/information.h"

#include <optional>
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

/// By which multiple of given moves the points of a solution have to move so that its errors are
/// least (engine/method.md, eq. 14l).
struct Multiple {
  double value = 0;
  double sigma = 0;       ///< standard deviation of `value`, by single tracks
  double chi_square = 0;  ///< decrease of the squared errors by `value`, per variance of the noise
};
/// Returns the multiple of `moves_px`, linearized around the solution; nullopt if that is not
/// determined.
std::optional<Multiple> multiple_of(const SolvedPlanes& solved,
                                    RotationModel model,
                                    const std::vector<Eigen::Matrix2Xd>& moves_px);

/// Adds the spread of the gyroscope noise, a random walk, if it is an unknown (engine/method.md,
/// eq. 14f).
void add_gyro_noise(const Sandwich& sandwich, Spread& spread);

/// Returns d(centers but the first, gyroscope, planes) / d(shared unknowns).
Eigen::MatrixXd results_by_shared(const PlaneMotion& motion, const Bread& bread);

/// Returns the displacements of the same results, one per column.
Eigen::MatrixXd moves_of_results(const Sandwich& sandwich, std::span<const SolutionMove> moves);

/// Returns the joint covariance of all camera centers but the first, the gyroscope bias if it is a
/// shared unknown, and the planes (`Uncertainty::joint_covariance`): the shrunk sum over tracks,
/// the sums over steps of the gyroscope's walk and over `of_image`, the moves by lens and readout,
/// and the rest of `shared`, the covariance of the shared unknowns by all errors.
Eigen::MatrixXd joint_covariance(const Sandwich& sandwich,
                                 const Influences& influences,
                                 double degrees_of_freedom,
                                 std::span<const SolutionMove> of_image,
                                 const SharedMatrix& shared);

/// Adds a change of `Uncertainty::joint_covariance`, in the order of its rows, to the covariances
/// of centers, bias, time offset and distances.
void add_to_marginals(const PlaneMotion& motion, const Eigen::MatrixXd& change, Uncertainty& u);

/// Returns the marginals of a covariance in the order of `Uncertainty::joint_covariance`; `u` has
/// the other planes.
NoiseSpread noise_spread(const PlaneMotion& motion,
                         const Eigen::MatrixXd& covariance,
                         const Uncertainty& u);

}  // namespace gpo
