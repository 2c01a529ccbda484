// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/dbscan.h"

#include "engine/methods/candidates/density_clusters.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/plane_result.h"
#include "engine/methods/plane/plane_translations.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Neighborhood of a normal: three standard deviations of a decomposition at |tau| = 0.3, 0.5 px of
/// noise and 150 tracks, and well below the angle between twins of a pair that is not degenerate.
constexpr double kRadiusDeg = 3;
/// Where the climb to the peak begins. Noise parts the twins of a camera that moves along the
/// normal, by the square root of its size and to either side of the truth; this holds both.
constexpr double kClimbDeg = 15;
/// Share of all frames' weight that must lie in a core point's neighborhood: a handful of agreeing
/// wide pairs, where the twins of a camera that turns its path scatter.
constexpr double kLeastShare = 0.1;
/// A second peak of this share of the density, beyond where the climb begins, is as likely.
constexpr double kAmbiguousShare = 0.8;
/// Of two likely peaks the one is taken whose readings' rotations are so much nearer to the given
/// ones; else the choice would be a guess.
constexpr double kTellingFactor = 1.25;

struct Candidates {
  std::vector<HomographyCandidate> all;
  std::vector<int> possible;                 ///< indices of those on the sphere
  std::vector<WeightedDirection> on_sphere;  ///< one a possible one
  std::vector<int> label;                    ///< its cluster
};

/// The error of a decomposition's normal goes with 1/|tau|: weights are inverse variances, relative
/// to the sum over frames.
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
  c.label = density_clusters(c.on_sphere, {.radius_deg = kRadiusDeg, .least_weight = kLeastShare});
  return c;
}

/// Weight of the normals near one, falling to zero at the radius (Epanechnikov).
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

/// Where the density is highest of the cluster's own members; nothing of no members.
std::optional<Peak> highest_member(const Candidates& c, const auto& belongs) {
  std::optional<Peak> peak;
  for (std::size_t k = 0; k < c.on_sphere.size(); ++k) {
    if (c.label[k] == kNoise || !belongs(c.on_sphere[k].direction)) continue;
    const double here = density(c.on_sphere, c.on_sphere[k].direction);
    if (!peak || here > peak->density) peak = {c.on_sphere[k].direction, here};
  }
  return peak;
}

/// Weighted median of the angles between the normals within `radius_deg` of `at` and it.
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
/// of what it holds (2.5 medians, in two dimensions), so that the mean is one of the peak only.
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

/// Of the readings that gather at a normal: how far their rotations are from the given ones, the
/// weighted mean [deg].
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

/// The densest peak, or of two alike the one whose rotations are nearer; or why it is a guess.
struct Choice {
  Peak peak;
  std::string doubt;
};

Choice choose_peak(const Candidates& c, const Peak& densest) {
  const auto other = highest_member(
      c, [&](const Vector3d& n) { return angle_deg(n, densest.normal) > kClimbDeg; });
  if (!other || other->density < kAmbiguousShare * densest.density) return {densest, ""};
  const double densest_deg = rotation_error_deg(c, densest.normal);
  const double other_deg = rotation_error_deg(c, other->normal);
  if (other_deg > kTellingFactor * densest_deg) return {densest, ""};
  if (densest_deg > kTellingFactor * other_deg) return {*other, ""};
  return {densest,
          fmt::format("two planes, {:.0f} deg apart, gather the candidate normals alike (density "
                      "{:.2f} and {:.2f}, rotations {:.1f} and {:.1f} deg from the given ones)",
                      angle_deg(other->normal, densest.normal),
                      densest.density,
                      other->density,
                      densest_deg,
                      other_deg)};
}

/// Says of each candidate away from the peak how far it is.
void reject_far_from(const Vector3d& normal, Candidates& candidates) {
  for (const int k : candidates.possible) {
    HomographyCandidate& candidate = candidates.all[k];
    const double angle = angle_deg(candidate.motion.normal, normal);
    if (angle > kRadiusDeg)
      candidate.reject(Rejection::normal,
                       fmt::format("normal {:.1f} deg from where the density peaks", angle));
  }
}

}  // namespace

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
    return failed_with(fmt::format("no plane: the {} possible normals of {} homographies gather "
                                   "nowhere within {} deg",
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
  return checked_result(window, std::move(result));
}

}  // namespace gpo
