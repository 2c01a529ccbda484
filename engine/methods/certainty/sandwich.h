// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Cluster-robust covariances (engine/method.md, eq. 14a and 14b): the bread, and what goes between.
#pragma once

#include "engine/methods/common/uncertainty.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_observations.h"
#include "engine/methods/plane/shared_unknowns.h"
#include "engine/window/window.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Over what all frames share (`UnknownsLayout`).
using SharedMatrix = Eigen::MatrixXd;
/// Over what is a frame's own: t, or phi and t where rotations are free or a gyroscope's noise is
/// unknown.
using OwnMatrix = Eigen::MatrixXd;
using OwnVector = Eigen::VectorXd;

int own_size(RotationModel model, const PlaneMotion& motion);

/// The observations of the leading plane (0) or a further one.
const std::vector<FrameObservations>& of_plane(const PlaneObservations& observations, int plane);

/// Where a frame's errors to one of the planes are linearized.
FrameState state_of(const PlaneObservations& observations,
                    const PlaneMotion& motion,
                    int frame,
                    int plane);
/// A frame's normal equations; under Huber's loss JtJ is what the loss itself bends by.
FrameNormals curved_normals(const FrameObservations& observations, const FrameState& state);

/// Huber's loss beyond its knee, k |r|, bends along the error not at all and across it by k / |r|;
/// the weights of its least squares, k / |r| both ways, would promise too much. Nothing where every
/// weight is one, or a matrix already.
std::optional<FrameObservations> curvature_weights(const FrameObservations& f,
                                                   const FrameState& state);
/// J^T r of an observation over (u, phi, t), of its own error or another one, weighted as it is.
Eigen::Matrix<double, 8, 1> gradient_of(const FrameObservations& f,
                                        const FrameState& state,
                                        int k,
                                        const Eigen::Vector2d& r);

struct Linearization {
  std::vector<std::vector<FrameNormals>> planes;  ///< the leading one first; one a frame
  double sigma_px = 0;                            ///< of a pixel's coordinate, from the residuals
};

/// Around a solution; nothing where a point lies behind a camera.
std::optional<Linearization> linearize(const PlaneObservations& observations,
                                       const PlaneMotion& motion,
                                       RotationModel model);

/// A frame's normal equations: what is its own is -(inverse g + gain x), x what all frames share.
struct Eliminated {
  OwnMatrix inverse;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, kMostShared> gain;
};

/// The bread: a linearized problem, its frames' own unknowns eliminated.
struct Bread {
  UnknownsLayout layout = {};
  std::vector<std::vector<PlaneColumns>> columns = {};  ///< of each plane, of each frame
  std::vector<Eliminated> frames = {};                  ///< the first one's is empty
  SharedMatrix prior = {};                              ///< the bias' [px^2]
  SharedMatrix information = {};  ///< on what the frames share, with the prior
  /// One a frame where a gyroscope's noise is unknown, its prior [px^2]; else empty.
  std::vector<double> noise_weights = {};

  /// Where the columns of a plane stand among all shared unknowns.
  std::vector<int> places(int plane) const;
};

/// How something that is wrong moves the solution: x what is shared, e what is a frame's own with x
/// left out, one a frame.
struct SolutionMove {
  Eigen::VectorXd shared;
  std::vector<OwnVector> own;
};

Bread bread_of(const Window& window,
               const PlaneMotion& motion,
               const Linearization& linearized,
               RotationModel model);

/// Sums over clusters of observations of how they move the solution: x what is shared, e what is a
/// frame's own with x left out.
struct Spread {
  SharedMatrix shared;              ///< sum x x^T
  std::vector<SharedMatrix> cross;  ///< one a frame: sum x e^T
  std::vector<OwnMatrix> own;       ///< sum e e^T
};

/// Clusters are tracks, and of what is shared frames, too; a frame's own unknowns take up what its
/// observations have in common. `shared_inverse` is that of the information on what the frames
/// share, zero in the rows and columns of what is held.
Spread spread_of(const Window& window,
                 const PlaneObservations& observations,
                 const PlaneMotion& motion,
                 const Bread& bread,
                 const SharedMatrix& shared_inverse,
                 double degrees_of_freedom);

/// Of each track that is seen, weighted so that their squares sum up to `spread_of`'s.
std::vector<SolutionMove> moves_by_track(const Window& window,
                                         const PlaneObservations& observations,
                                         const PlaneMotion& motion,
                                         const Bread& bread,
                                         const SharedMatrix& shared_inverse,
                                         double degrees_of_freedom);

}  // namespace gpo
