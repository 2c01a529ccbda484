// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_result.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

/// Neighborhood of a normal: three standard deviations of a decomposition at |tau| = 0.3, 0.5 px of
/// noise and 150 tracks, and well below the angle between twins unless the pair is degenerate.
constexpr double kRadiusDeg = 3;
/// First radius of the climb to the peak. If the camera moves along the normal, noise separates the
/// twins to either side of the truth by the square root of its size; this contains both.
constexpr double kClimbDeg = 15;
/// Least share of all frames' weight in a core point's neighborhood: a few agreeing pairs with
/// large translations. On a curved path the twins scatter.
constexpr double kLeastShareOfCore = 0.1;
/// A second peak with this share of the density outside of the first radius is equally likely.
constexpr double kAmbiguousShare = 0.8;
/// Least ratio of the rotation errors by which one of two likely peaks is selected.
constexpr double kDecisiveFactor = 1.25;

constexpr int kUnvisited = -2;

struct Neighborhood {
  std::vector<int> near;  ///< including the point itself
  bool core = false;
};

std::vector<Neighborhood> neighborhoods(std::span<const WeightedDirection> points,
                                        double radius_deg,
                                        double least_weight) {
  std::vector<Neighborhood> all(points.size());
  for (Neighborhood& of : all) {
    const WeightedDirection& point = points[&of - all.data()];
    double weight = 0;
    for (int b = 0; b < std::ssize(points); ++b) {
      if (angle_deg(point.direction, points[b].direction) > radius_deg) continue;
      of.near.push_back(b);
      weight += points[b].weight;
    }
    of.core = weight >= least_weight;
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

struct Candidates {
  std::vector<HomographyCandidate> all;
  std::vector<int> possible;                 ///< indices of the feasible ones
  std::vector<WeightedDirection> on_sphere;  ///< their normals
  std::vector<int> label;                    ///< their clusters
};

/// The error of a decomposition's normal is proportional to 1/|tau|: weights are inverse variances,
/// relative to the sum over frames.
Candidates cluster_candidates(const std::vector<std::vector<HomographyCandidate>>& frames) {
  Candidates c;
  double weights = 0;
  for (const std::vector<HomographyCandidate>& of_frame : frames) {
    const HomographyCandidate* best = best_of(of_frame);
    if (best != nullptr) weights += best->motion.tau.squaredNorm();
    c.all.insert(c.all.end(), of_frame.begin(), of_frame.end());
  }
  for (int k = 0; k < static_cast<int>(c.all.size()); ++k) {
    if (!c.all[k].taken()) continue;
    const HomographyMotion& motion = c.all[k].motion;
    c.possible.push_back(k);
    c.on_sphere.push_back({motion.normal, motion.tau.squaredNorm() / weights});
  }
  c.label = density_clusters(c.on_sphere, kRadiusDeg, kLeastShareOfCore);
  return c;
}

/// Returns the kernel density of the normals (Epanechnikov).
double density(std::span<const WeightedDirection> points, const Vector3d& at) {
  double sum = 0;
  for (const auto& [direction, weight] : points) {
    const double ratio = angle_deg(direction, at) / kRadiusDeg;
    if (ratio < 1) sum += weight * (1 - ratio * ratio);
  }
  return sum;
}

struct Peak {
  Vector3d normal;
  double density;  ///< [share of all frames' weight]
};

/// Returns the accepted cluster member with the highest density; nullopt without members.
std::optional<Peak> highest_member(const Candidates& c, const auto& accepts) {
  std::optional<Peak> peak;
  for (std::size_t k = 0; k < c.on_sphere.size(); ++k) {
    if (c.label[k] == kNoise || !accepts(c.on_sphere[k].direction)) continue;
    const double here = density(c.on_sphere, c.on_sphere[k].direction);
    if (!peak || here > peak->density) peak = {c.on_sphere[k].direction, here};
  }
  return peak;
}

/// Returns the weighted median angle between `at` and the normals within `radius_deg` of it.
double median_angle_deg(std::span<const WeightedDirection> points,
                        const Vector3d& at,
                        double radius_deg) {
  std::vector<std::pair<double, double>> near;  // angle, weight
  double weights = 0;
  for (const auto& [direction, weight] : points) {
    const double angle = angle_deg(direction, at);
    if (angle > radius_deg) continue;
    near.emplace_back(angle, weight);
    weights += weight;
  }
  std::ranges::sort(near);
  double below = 0;
  for (const auto& [angle, weight] : near) {
    below += weight;
    if (below >= weights / 2) return angle;
  }
  return radius_deg;
}

/// Mean shift from the densest member to the peak. The radius shrinks to three standard deviations
/// of the normals inside (2.5 medians, in two dimensions), which excludes other peaks.
Vector3d climb(std::span<const WeightedDirection> points, Vector3d normal) {
  double radius_deg = kClimbDeg;
  for (int round = 0; round < 20; ++round) {
    Vector3d sum = Vector3d::Zero();
    for (const auto& [direction, weight] : points) {
      if (angle_deg(direction, normal) <= radius_deg) sum += weight * direction;
    }
    if (sum.norm() < 1e-12) break;
    const Vector3d next = sum.normalized();
    if (angle_deg(next, normal) < 1e-9) break;
    normal = next;
    radius_deg = std::min(kClimbDeg, 2.5 * median_angle_deg(points, normal, radius_deg));
  }
  return normal;
}

Initialization failed_with(std::string reason, Candidates& candidates) {
  Initialization result = failed(std::move(reason));
  result.candidates = std::move(candidates.all);
  return result;
}

/// Returns the weighted mean angle between the given rotations and those of the decompositions near
/// a normal [deg].
double rotation_error_deg(const Candidates& c, const Vector3d& normal) {
  double sum = 0;
  double weights = 0;
  for (std::size_t k = 0; k < c.possible.size(); ++k) {
    if (angle_deg(c.on_sphere[k].direction, normal) > kClimbDeg) continue;
    sum += c.on_sphere[k].weight * c.all[c.possible[k]].score;
    weights += c.on_sphere[k].weight;
  }
  return sum / weights;
}

/// The densest peak, or of two similar ones that with better rotations.
struct Choice {
  Peak peak;
  std::string doubt;  ///< why it is ambiguous; empty otherwise
};

Choice choose_peak(const Candidates& c, const Peak& densest) {
  const auto other = highest_member(
      c, [&](const Vector3d& n) { return angle_deg(n, densest.normal) > kClimbDeg; });
  if (!other || other->density < kAmbiguousShare * densest.density) return {densest, ""};
  const double densest_deg = rotation_error_deg(c, densest.normal);
  const double other_deg = rotation_error_deg(c, other->normal);
  if (other_deg > kDecisiveFactor * densest_deg) return {densest, ""};
  if (densest_deg > kDecisiveFactor * other_deg) return {*other, ""};
  return {
      densest,
      fmt::format("ambiguous: two plane orientations {:.0f} deg apart fit equally well (density "
                  "{:.2f} and {:.2f}, rotations {:.1f} and {:.1f} deg from the given ones)",
                  angle_deg(other->normal, densest.normal),
                  densest.density,
                  other->density,
                  densest_deg,
                  other_deg)};
}

/// Rejects the candidates far from the peak.
void reject_far_from(const Vector3d& normal, Candidates& candidates) {
  for (const int k : candidates.possible) {
    HomographyCandidate& candidate = candidates.all[k];
    const double angle = angle_deg(candidate.motion.normal, normal);
    if (angle > kRadiusDeg)
      candidate.reject(Rejection::normal,
                       fmt::format("normal {:.1f} deg from the density peak", angle));
  }
}

}  // namespace

std::vector<int> density_clusters(std::span<const WeightedDirection> points,
                                  double radius_deg,
                                  double least_weight) {
  const std::vector<Neighborhood> all = neighborhoods(points, radius_deg, least_weight);
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

std::vector<NormalCluster> normal_clusters(
    const std::vector<std::vector<HomographyCandidate>>& candidates) {
  const Candidates c = cluster_candidates(candidates);
  std::vector<NormalCluster> clusters;
  for (std::size_t k = 0; k < c.label.size(); ++k) {
    if (c.label[k] == kNoise) continue;
    clusters.resize(std::max<std::size_t>(clusters.size(), c.label[k] + 1),
                    {Vector3d::Zero(), 0, 0, 0});
    NormalCluster& cluster = clusters[c.label[k]];
    cluster.normal += c.on_sphere[k].weight * c.on_sphere[k].direction;
    cluster.weight += c.on_sphere[k].weight;
    ++cluster.members;
  }
  for (NormalCluster& cluster : clusters) cluster.normal.normalize();
  for (std::size_t k = 0; k < c.label.size(); ++k) {
    if (c.label[k] == kNoise) continue;
    NormalCluster& cluster = clusters[c.label[k]];
    cluster.radius_deg =
        std::max(cluster.radius_deg, angle_deg(cluster.normal, c.on_sphere[k].direction));
  }
  return clusters;
}

Initialization initialize_dbscan(const Window& window, const Watch& watch) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  Candidates candidates = cluster_candidates(candidates_of_window(window, watch.stop));
  if (watch.stop_requested()) return stopped_early();
  const auto start = highest_member(candidates, [](const Vector3d&) { return true; });
  if (!start) {
    return failed_with(fmt::format("no plane: the {} feasible normals of {} homographies have no "
                                   "cluster within {} deg",
                                   candidates.possible.size(),
                                   window.frame_count() - 1,
                                   kRadiusDeg),
                       candidates);
  }
  const auto [peak, doubt] = choose_peak(candidates, *start);
  const Vector3d normal = climb(candidates.on_sphere, peak.normal);
  reject_far_from(normal, candidates);
  if (!doubt.empty()) return failed_with(doubt, candidates);
  Initialization result;
  result.plane = {normal, 1};
  result.cameras.push_back({});
  for (int i = 1; i < window.frame_count(); ++i) {
    if (watch.stop_requested()) return stopped_early();
    result.cameras.push_back({window.R_wc[i], -translation_given_normal(window, i, normal)});
  }
  result.candidates = std::move(candidates.all);
  return with_map_points(window, std::move(result));
}

}  // namespace gpo
