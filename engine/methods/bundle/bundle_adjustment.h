// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/residuals/ceres_solver.h"
#include "engine/window/window.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

struct Observation {
  int frame;
  int point;              ///< column of the bundle's points
  Eigen::Vector2d pixel;  ///< undistorted [px]
};

/// Returns the accepted observations of the window's tracks, with those of the reference frame for
/// each track that has any; a point is a track.
std::vector<Observation> track_observations(
    const Window& window, const std::function<bool(int frame, int track)>& accepts);

/// Poses and points of a window; world = reference camera, free scale.
struct Bundle {
  std::vector<Pose> cameras;  ///< one per frame, the first one is the identity
  Eigen::Matrix3Xd points;    ///< 3 x points: reference pixel u v [px], inverse depth rho
  /// Normal of the plane n.P + 1 = 0 of all points; zero if the points are free.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// Returns a bundle with all points on the plane n.P + 1 = 0, rho = -n.x_1. `pixels_1`: 2 x points,
/// in the reference image [px].
Bundle bundle_on_plane(const Eigen::Matrix3d& K,
                       const std::vector<Pose>& cameras,
                       const Eigen::Vector3d& normal,
                       const Eigen::Matrix2Xd& pixels_1);

/// Returns the position of a bundle's point, K^-1 (u v 1)^T / rho.
Eigen::Vector3d position(const Eigen::Matrix3d& K, const Eigen::Vector3d& point);

/// Returns the reprojection error of each observation [px]; infinite behind a camera.
std::vector<double> reprojection_errors_px(const Eigen::Matrix3d& K,
                                           const Bundle& bundle,
                                           std::span<const Observation> observations);

/// Stops at a constant cost, or at the gradient of the last 1e-9 px of the residuals. If the camera
/// approaches a plane along its normal, free rotations leave such a flat valley that a noise-free
/// solve would otherwise not end.
inline constexpr SolverTolerances kAdjustmentTolerances{1e-10, 1e-6};

struct AdjustmentOptions {
  double huber_px = 0;  ///< knee of the Huber loss; 0 for plain least squares [px]
  SolverTolerances tolerances = kAdjustmentTolerances;
  /// All points stay on one plane, whose distance 1 is the scale; nullopt: the points are free.
  std::optional<PlaneNormal> normal = {};
};

struct AdjustedBundle {
  Bundle bundle;
  SolverReport solver;
  std::vector<Observation> kept = {};  ///< final ones of `adjust_bundle_robustly`
};

/// Minimizes the reprojection error over all poses and observed points. The first camera is held.
/// Free points: so is the distance of the farthest camera from it (scale), 6m + 3n - 7 unknowns. On
/// a plane: 6m + 2n - 6 unknowns, two fewer with the normal held. Fails if the start has
/// observations behind a camera.
AdjustedBundle adjust_bundle(const Eigen::Matrix3d& K,
                             const Bundle& start,
                             std::span<const Observation> observations,
                             const AdjustmentOptions& options,
                             const Watch& watch);

/// Adjusts free points with a Huber loss, drops outliers (observations beyond three robust standard
/// deviations, points behind the reference camera or seen fewer than three times, tracks that
/// slipped), and adjusts the rest to plain least squares. `error_px` is the expected median error
/// of an observation, a lower limit of the standard deviation: otherwise tracks with a common drift
/// could outvote the others. The initial cost is that of the start and all its observations.
AdjustedBundle adjust_bundle_robustly(const Eigen::Matrix3d& K,
                                      const Bundle& start,
                                      std::span<const Observation> observations,
                                      double error_px,
                                      const Watch& watch);

}  // namespace gpo
