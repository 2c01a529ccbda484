// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/candidates/density_clusters.h"

#include "engine/geometry/pose.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace gpo {
namespace {

constexpr int kUnvisited = -2;

std::vector<std::vector<int>> neighborhoods(std::span<const WeightedDirection> points,
                                            double radius_deg) {
  const int count = static_cast<int>(points.size());
  std::vector<std::vector<int>> near(points.size());
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      if (angle_deg(points[a].direction, points[b].direction) <= radius_deg) near[a].push_back(b);
    }
  }
  return near;
}

std::vector<bool> core_points(std::span<const WeightedDirection> points,
                              const std::vector<std::vector<int>>& near,
                              double least_weight) {
  std::vector<bool> core;
  for (const auto& neighbors : near) {
    double weight = 0;
    for (const int k : neighbors) weight += points[k].weight;
    core.push_back(weight >= least_weight);
  }
  return core;
}

/// Labels all core points that can be reached from `seed` over core points.
void flood(int seed,
           int label,
           const std::vector<std::vector<int>>& near,
           const std::vector<bool>& core,
           std::vector<int>& labels) {
  std::vector<int> open{seed};
  labels[seed] = label;
  while (!open.empty()) {
    const int a = open.back();
    open.pop_back();
    for (const int b : near[a]) {
      if (!core[b] || labels[b] != kUnvisited) continue;
      labels[b] = label;
      open.push_back(b);
    }
  }
}

int label_of_nearest_core(int point,
                          std::span<const WeightedDirection> points,
                          const std::vector<int>& near,
                          const std::vector<bool>& core,
                          const std::vector<int>& labels) {
  int label = kNoise;
  double least_deg = std::numeric_limits<double>::infinity();
  for (const int k : near) {
    const double apart_deg = angle_deg(points[k].direction, points[point].direction);
    if (!core[k] || apart_deg >= least_deg) continue;
    least_deg = apart_deg;
    label = labels[k];
  }
  return label;
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
  const auto near = neighborhoods(points, options.radius_deg);
  const std::vector<bool> core = core_points(points, near, options.least_weight);
  const int count = static_cast<int>(points.size());
  std::vector<int> labels(points.size(), kUnvisited);
  int clusters = 0;
  for (int k = 0; k < count; ++k) {
    if (core[k] && labels[k] == kUnvisited) flood(k, clusters++, near, core, labels);
  }
  for (int k = 0; k < count; ++k) {
    if (!core[k]) labels[k] = label_of_nearest_core(k, points, near[k], core, labels);
  }
  sort_by_weight(points, clusters, labels);
  return labels;
}

}  // namespace gpo
