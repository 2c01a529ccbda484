// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Possible normals of many frames that are dense together.
struct NormalCluster {
  Eigen::Vector3d normal;  ///< their weighted mean, unit
  double weight = 0;       ///< of the possible normals in it [share of all frames' weight]
  int members = 0;
  double radius_deg = 0;  ///< from the mean to the farthest member
};

/// What DBSCAN sees in the readings of a window's homographies (`candidates_of_window`); the
/// heaviest first.
std::vector<NormalCluster> normal_clusters(
    const std::vector<std::vector<HomographyCandidate>>& candidates);

/// The paper's second baseline: decomposes the homography of every frame, clusters all possible
/// normals on the unit sphere by density (DBSCAN, Ester et al. 1996) and takes the normal where the
/// density peaks; translations by linear least squares given it. The window's rotations tell true
/// readings from false ones and are delivered as they are. Nothing is optimized.
Initialization initialize_dbscan(const Window& window, const Watch& watch);

}  // namespace gpo
