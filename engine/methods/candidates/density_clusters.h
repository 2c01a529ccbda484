// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

struct WeightedDirection {
  Eigen::Vector3d direction;  ///< unit length
  double weight = 1;
};

struct DensityOptions {
  double radius_deg = 3;    ///< radius of a neighborhood [deg]
  double least_weight = 3;  ///< least weight around a core point, including itself
};

inline constexpr int kNoise = -1;

/// Returns the cluster of each direction by DBSCAN (Ester et al. 1996) with angular distance: core
/// points within one radius of each other share a cluster; any other point joins that of the
/// nearest core point within one radius or is kNoise. Cluster 0 is the heaviest. The order of the
/// points affects only the numbers of equally heavy clusters.
std::vector<int> density_clusters(std::span<const WeightedDirection> points,
                                  const DensityOptions& options);

}  // namespace gpo
