// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A direction on the unit sphere that counts as `weight` of them.
struct WeightedDirection {
  Eigen::Vector3d direction;
  double weight = 1;
};

struct DensityOptions {
  double radius_deg = 3;    ///< of a neighborhood [deg]
  double least_weight = 3;  ///< in a core point's neighborhood, itself counted [weight]
};

inline constexpr int kNoise = -1;

/// DBSCAN (Ester et al. 1996) with angular distance: core points within one radius of each other
/// share a cluster, any other point joins that of the nearest core point within one radius or is
/// kNoise. The heaviest cluster is number 0; nothing depends on the order of the points but the
/// numbers of equally heavy clusters.
std::vector<int> density_clusters(std::span<const WeightedDirection> points,
                                  const DensityOptions& options);

}  // namespace gpo
