// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/plane/plane_solver.h"
#include "engine/window/window.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Global plane optimization (Du et al. 2020): minimizes the summed squared transfer error of the
/// inliers over the plane's normal and the scaled translations of all frames, with the window's
/// rotations fixed; 3m - 1 unknowns. Decomposes no homography and triangulates no point. Ceres
/// starts at rest as in the paper, our own solver from the closed form.
Initialization initialize_gpo(const Window& window,
                              const MethodOptions& options,
                              const Watch& watch);
/// Returns the minimum of `initialize_gpo` without any checks; its sign is arbitrary.
PlaneSolution solve_gpo(const Window& window, const MethodOptions& options, const Watch& watch);

/// Global plane optimization that also estimates the uncertain part of the rotations: a constant
/// gyroscope bias (Gaussian prior), the gyroscope's integrated noise and, optionally, the offset
/// between the clocks; without a gyroscope the rotation of every frame. Starts from GPO with the
/// given rotations. Fails if it ends in a wrong minimum.
Initialization initialize_gpo_joint(const Window& window,
                                    const MethodOptions& options,
                                    const Watch& watch);

/// Returns plane and cameras of `initialize_gpo_joint` for a window without some tracks, started
/// from the result of all tracks, with the same unknowns.
Initialization restart_gpo_joint(const Window& window,
                                 const Initialization& start,
                                 const MethodOptions& options,
                                 const Watch& watch);

/// Closed-form normal, with translations by linear least squares over the inliers.
Initialization initialize_closed_form(const Window& window, const Watch& watch);

/// The paper's first baseline: decomposes the homography of the widest suitable pair, triangulates
/// its points, and adds the other frames in order by perspective-n-point and triangulation (Lepetit
/// et al. 2009). The window's rotations only select the decomposition. Returns the triangulated
/// inlier tracks; gauge and normal are those of the plane fitted to them.
Initialization initialize_pnp(const Window& window, const Watch& watch);

/// The paper's second baseline: decomposes the homography of every frame, clusters all feasible
/// normals on the unit sphere (DBSCAN, Ester et al. 1996) and takes the normal at the density peak;
/// translations by linear least squares. The window's rotations select the decompositions and are
/// returned unchanged. Optimizes nothing.
Initialization initialize_dbscan(const Window& window, const Watch& watch);

struct WeightedDirection {
  Eigen::Vector3d direction;  ///< unit length
  double weight = 1;
};

inline constexpr int kNoise = -1;

/// Returns the cluster of each direction by DBSCAN with angular distance: core points, with at
/// least `least_weight` within the radius, itself included, share a cluster if they are within it;
/// any other point joins that of the nearest core point within the radius or is kNoise. Cluster 0
/// is the heaviest. The order of the points affects only the numbers of equally heavy clusters.
std::vector<int> density_clusters(std::span<const WeightedDirection> points,
                                  double radius_deg,
                                  double least_weight);

/// A cluster of feasible normals of many frames.
struct NormalCluster {
  Eigen::Vector3d normal;  ///< weighted mean, unit length
  double weight = 0;       ///< sum over its normals [share of all frames' weight]
  int members = 0;
  double radius_deg = 0;  ///< from the mean to the farthest member
};

/// Returns DBSCAN's clusters in the decompositions of a window's homographies
/// (`candidates_of_window`), the heaviest first.
std::vector<NormalCluster> normal_clusters(
    const std::vector<std::vector<HomographyCandidate>>& candidates);

/// Bundle adjustment over all poses and points from `start`, with all tracks if
/// `Window::all_tracks`, else the inliers. The plane is fitted to the adjusted inlier points, which
/// are returned as they are, on the plane or off it. The paper's BA from `initialize_dbscan`, and
/// its "BA with PnP", the vision part of VINS, from `initialize_pnp`.
Initialization refine_bundle(const Window& window, const Initialization& start, const Watch& watch);

/// Bundle adjustment of the inliers with all points on one plane, from the poses and the plane of
/// `start`. The paper's PBA (free normal) and FPBA (held) from `initialize_dbscan`.
template <PlaneNormal normal>
Initialization refine_on_plane(const Window& window,
                               const Initialization& start,
                               const Watch& watch);

}  // namespace gpo
