// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/candidates/density_clusters.h"

#include "engine/geometry/pose.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>

namespace gpo {
namespace {

constexpr int kUnvisited = -2;

struct Neighborhood {
  std::vector<int> near;  ///< including the point itself
  bool core = false;
};

std::vector<Neighborhood> neighborhoods(std::span<const WeightedDirection> points,
                                        const DensityOptions& options) {
  std::vector<Neighborhood> all(points.size());
  for (Neighborhood& of : all) {
    const WeightedDirection& point = points[&of - all.data()];
    double weight = 0;
    for (int b = 0; b < std::ssize(points); ++b) {
      if (angle_deg(point.direction, points[b].direction) > options.radius_deg) continue;
      of.near.push_back(b);
      weight += points[b].weight;
    }
    of.core = weight >= options.least_weight;
  }
  return all;
}

/// Labels all core points that can be reached from `seed` over core points.
void flood(int seed, int label, const std::vector<Neighborhood>& all, std::vector<int>& labels) {
  std::vector<int> open{seed};
  labels[seed] = label;
  while (!open.empty()) {
    const int a = open.back();
    open.pop_back();
    for (const int b : all[a].near) {
      if (!all[b].core || labels[b] != kUnvisited) continue;
      labels[b] = label;
      open.push_back(b);
    }
  }
}

/// Renumbers the clusters by weight, the heaviest first.
void sort_by_weight(std::span<const WeightedDirection> points,
                    int clusters,
                    std::vector<int>& labels) {
  std::vector<double> weights(clusters, 0.0);
  for (std::size_t k = 0; k < labels.size(); ++k) {
    if (labels[k] != kNoise) weights[labels[k]] += points[k].weight;
  }
  std::vector<int> order(clusters);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater{}, [&](int label) { return weights[label]; });
  std::vector<int> rank(clusters);
  for (int place = 0; place < clusters; ++place) rank[order[place]] = place;
  for (int& label : labels) label = label == kNoise ? kNoise : rank[label];
}

}  // namespace

std::vector<int> density_clusters(std::span<const WeightedDirection> points,
                                  const DensityOptions& options) {
  const std::vector<Neighborhood> all = neighborhoods(points, options);
  const int count = static_cast<int>(points.size());
  std::vector<int> labels(points.size(), kUnvisited);
  int clusters = 0;
  for (int k = 0; k < count; ++k) {
    if (all[k].core && labels[k] == kUnvisited) flood(k, clusters++, all, labels);
  }
  for (int k = 0; k < count; ++k) {
    if (all[k].core) continue;
    std::vector<int> cores;
    std::ranges::copy_if(
        all[k].near, std::back_inserter(cores), [&](int b) { return all[b].core; });
    const auto nearest = std::ranges::min_element(
        cores, {}, [&](int b) { return angle_deg(points[b].direction, points[k].direction); });
    labels[k] = nearest == cores.end() ? kNoise : labels[*nearest];
  }
  sort_by_weight(points, clusters, labels);
  return labels;
}

}  // namespace gpo
