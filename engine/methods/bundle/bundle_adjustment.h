// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/methods/residuals/ceres_solver.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A point seen in a frame.
struct Observation {
  int frame;
  int point;              ///< column of the bundle's points
  Eigen::Vector2d pixel;  ///< undistorted [px]
};

/// Poses and points of a window; world = reference camera, the scale is free.
struct Bundle {
  std::vector<Pose> cameras;  ///< one a frame, the first one the identity
  Eigen::Matrix3Xd points;    ///< 3 x points: reference pixel u v [px], inverse depth rho
};

/// The point's position, K^-1 (u v 1)^T / rho.
Eigen::Vector3d position(const Eigen::Matrix3d& K, const Eigen::Vector3d& point);

/// Reprojection error of each observation [px]; infinite behind a camera.
std::vector<double> reprojection_errors_px(const Eigen::Matrix3d& K,
                                           const Bundle& bundle,
                                           std::span<const Observation> observations);

/// Ends of an adjustment: a cost that stands still, or a gradient that the last 1e-9 px of the
/// residuals make. Where the camera approaches a plane along its normal, free rotations leave a
/// valley so flat that a noise-free solve would creep along it for ever.
inline constexpr SolverTolerances kAdjustmentTolerances{1e-10, 1e-6};

struct AdjustmentOptions {
  double huber_px = 0;  ///< errors above it count linearly; 0: plain least squares [px]
  SolverTolerances tolerances = kAdjustmentTolerances;
};

struct AdjustedBundle {
  Bundle bundle;
  SolverReport solver;
};

/// Least reprojection error over all poses and points that are observed, every observation one
/// residual: the first camera is held, and so is the distance of the widest frame's camera from it
/// (scale). 6m + 3n - 7 unknowns. Observations behind a camera at the start make it fail.
AdjustedBundle adjust_bundle(const Eigen::Matrix3d& K,
                             const Bundle& start,
                             std::span<const Observation> observations,
                             const AdjustmentOptions& options,
                             const Watch& watch);

struct RobustBundle {
  Bundle bundle;
  std::vector<Observation> kept;  ///< what the final adjustment used
  SolverReport solver;            ///< initial cost: of the start and all observations that it uses
};

/// Adjusts with a Huber loss, drops what then disagrees (observations beyond three robust standard
/// deviations, points behind the reference camera or seen fewer than three times, whole tracks that
/// slipped), and adjusts the rest to plain least squares. `error_px` is the expected median error
/// of an observation; no deviation is taken to be smaller, or tracks that drift alike would outvote
/// the others.
RobustBundle adjust_bundle_robustly(const Eigen::Matrix3d& K,
                                    const Bundle& start,
                                    std::span<const Observation> observations,
                                    double error_px,
                                    const Watch& watch);

}  // namespace gpo
