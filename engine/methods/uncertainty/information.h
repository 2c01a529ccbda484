// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Information about the unknowns of a solution, and cluster-robust covariances ("sandwich",
// engine/method.md, eq. 13 to 14b).
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Matrix over the unknowns that all frames share (`UnknownsLayout`).
using SharedMatrix = Eigen::MatrixXd;
/// Matrix over a frame's own unknowns: t, or (phi, t) with free rotations or gyroscope noise.
using OwnMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using OwnVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Returns the number of a frame's own unknowns.
int own_size(RotationModel model, const PlaneMotion& motion);

struct Linearization {
  std::vector<std::vector<FrameNormals>> planes;  ///< main plane first; one per frame
  double sigma_px = 0;                            ///< noise of a coordinate, from the residuals
};

/// Linearizes a solution; nullopt if a point is behind a camera.
std::optional<Linearization> linearize(const SolvedPlanes& solved, RotationModel model);

/// The solution for a frame's own unknowns is -(inverse g + gain x), where x are the shared ones.
struct Eliminated {
  OwnMatrix inverse;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, kMostShared> gain;
};

/// The "bread": the linearized problem with the frames' own unknowns eliminated.
struct Bread {
  UnknownsLayout layout = {};
  int own = 3;                                          ///< number of a frame's own unknowns
  std::vector<std::vector<PlaneColumns>> columns = {};  ///< for each plane and frame
  std::vector<Eliminated> frames = {};                  ///< the first one is empty
  SharedMatrix prior = {};                              ///< prior of the bias [px^2]
  SharedMatrix information = {};  ///< about the shared unknowns, including the prior
  /// Prior of the gyroscope noise, one per frame [px^2]; empty if the noise is not an unknown.
  std::vector<double> noise_weights = {};

  /// Returns the indices of a plane's columns among the shared unknowns.
  std::vector<int> places(int plane) const;
};

Bread bread_of(const SolvedPlanes& solved, const Linearization& linearized, RotationModel model);
/// Eliminates the frames' own unknowns for a linearization by other observations, or with other
/// weights, at the same solution.
void eliminate(const Linearization& linearized, Bread& bread);

/// A solution with its bread and the inverse of the information about the shared unknowns, which is
/// zero in the rows and columns of held unknowns.
struct Sandwich {
  const SolvedPlanes& solved;
  const Bread& bread;
  const SharedMatrix& inverse;
};

/// Displacement of the solution by an error: x of the shared unknowns, and e of each frame's own
/// unknowns at fixed x.
struct SolutionMove {
  Eigen::VectorXd shared;
  std::vector<OwnVector> own;  ///< one per frame
};

/// Returns the gradient over the shared unknowns with the frames' own ones eliminated, without the
/// priors. `bread` may be that of other observations.
Eigen::VectorXd reduced_gradient(const Linearization& linearized, const Bread& bread);

/// Displacements of the solution by all observations, one per column, frame by frame.
struct Influences {
  Eigen::MatrixXd shared;           ///< x, of the shared unknowns
  Eigen::MatrixXd own;              ///< e, of the own unknowns of the observation's frame
  std::vector<int> track;           ///< one per column
  std::vector<Eigen::Index> first;  ///< first column of each frame, and the number of columns
};

Influences influences_of(const Sandwich& sandwich);

/// Returns the power of the part of a symmetric matrix that is positive definite.
Eigen::MatrixXd power_of_positive(const Eigen::MatrixXd& A, double power);
/// Returns the sum over all columns m of m m^T.
Eigen::MatrixXd square_of(const Eigen::MatrixXd& moves);

/// Returns `square`, the square of the moves, shrunk toward `independent`, the covariance for
/// independent errors: of few moves, it knows nothing about most directions, and its inverse would
/// claim that these are exact (engine/method.md, eq. 14g).
Eigen::MatrixXd shrunk_covariance(const Eigen::MatrixXd& moves,
                                  const Eigen::MatrixXd& square,
                                  const Eigen::MatrixXd& independent);

/// Returns a covariance with the correlations of `covariance` between the diagonal blocks of
/// `blocks`, which have these sizes.
Eigen::MatrixXd with_blocks_of(const Eigen::MatrixXd& blocks,
                               std::span<const int> sizes,
                               Eigen::MatrixXd covariance);

/// Sums over clusters of observations of their displacements x and e of the solution.
struct Spread {
  SharedMatrix shared;              ///< sum x x^T
  std::vector<SharedMatrix> cross;  ///< sum x e^T, one per frame
  std::vector<OwnMatrix> own;       ///< sum e e^T, one per frame

  void add(const SolutionMove& move);
};

/// Returns the spread with tracks as clusters and, for the shared unknowns, also frames; errors
/// that all observations of a frame share go into its own unknowns.
Spread spread_of(const Sandwich& sandwich, const Influences& all, double degrees_of_freedom);

/// Information about the normal (tangents u) and, with an unknown bias, bias and time offset, with
/// translations and free rotations marginalized, per square pixel of noise.
using SharedInformation = Eigen::MatrixXd;

/// Returns the information of the priors of bias and time offset, if these are unknown.
SharedInformation prior_information(const Window& window,
                                    const UnknownsLayout& layout,
                                    double sigma_px);
/// Returns the information of one frame; `normals` with rotation.
SharedInformation frame_information(const Window& window,
                                    int frame,
                                    const FrameNormals& normals,
                                    RotationModel model);

/// Returns the standard deviation of the normal's angle, the root of its covariance's trace [deg];
/// nullopt if it is not determined.
std::optional<double> normal_sigma_deg(const SharedInformation& information, double sigma_px);

/// Returns the Cramér-Rao bound of the normal's angle [deg] (engine/method.md, eq. 13 and 14) with
/// unknown translations, known rotations, exact reference points and independent noise of
/// `sigma_px` on each coordinate of the inlier observations; nullopt if the window does not
/// determine it.
std::optional<double> normal_bound_deg(const Window& window,
                                       const Plane& plane,
                                       std::span<const Pose> cameras,
                                       double sigma_px);

/// Returns the inverse if the matrix is positive definite beyond rounding after scaling its rows.
std::optional<Eigen::MatrixXd> inverse_information(const Eigen::MatrixXd& information);

}  // namespace gpo
