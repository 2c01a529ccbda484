// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/decompositions.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/statistics.h"
#include "engine/rotations/rotations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kLeastPairTracks = 12;
constexpr double kNormalCapDeg = 10;    // a candidate farther from the common normal is the twin
constexpr double kClearlyWorse = 2.25;  // cost ratio below which two planes are ambiguous
constexpr double kPlausible = 9;        // cost ratio of a plane that may still be the right one
constexpr double kClearlyApart = 2;     // ratio of rotation errors that resolves an ambiguity
constexpr double kFullParallax = 0.15;  // |tau| from which on a decomposition has full weight

struct Pair {
  int j;
  Matrix3d H_ji;                          // Euclidean: rays of frame i to rays of j, any scale
  std::vector<HomographyMotion> motions;  // from frame i to j; empty if the camera hardly moved
};

std::optional<Pair> decompose_pair(const Window& window, int i, int j) {
  std::vector<int> common;
  for (int k = 0; k < window.track_count(); ++k) {
    const bool in_i = i == 0 ? window.points_px[0].col(k).allFinite() : bool{window.inlier[i][k]};
    if (in_i && window.inlier[j][k]) common.push_back(k);
  }
  if (static_cast<int>(common.size()) < kLeastPairTracks) return std::nullopt;
  const Matrix2Xd from = window.points_px[i](Eigen::all, common);
  const Matrix2Xd to = window.points_px[j](Eigen::all, common);
  const Matrix3d start = window.H_i1[j] * window.H_i1[i].inverse();
  if (!start.allFinite()) return std::nullopt;
  const Matrix3d H = refine_homography(start, from, to);
  return Pair{.j = j,
              .H_ji = window.K.inverse() * H * window.K,
              .motions = decompose_homography(H, window.K, from)};
}

/// Returns R_ji for a known normal (in frame i): H' = lambda R (I - tau n^T) maps directions on the
/// plane by R alone. Suits pairs of little parallax, where a decomposition is ill-posed.
Matrix3d rotation_given_normal(const Matrix3d& H_ji, const Vector3d& normal) {
  Matrix3d from;
  from << normal_tangents(normal), normal;
  Matrix3d to = H_ji * from;
  to.col(2) = to.col(0).cross(to.col(1)).normalized();
  return nearest_rotation(to) * from.transpose();
}

double weight_of(const HomographyMotion& motion) {
  const double parallax = std::min(motion.tau.norm() / kFullParallax, 1.0);
  return parallax * parallax;
}

const HomographyMotion& nearest(const std::vector<HomographyMotion>& motions,
                                const Vector3d& normal) {
  return *std::ranges::max_element(
      motions, {}, [&](const auto& m) { return m.normal.dot(normal); });
}

/// R_ji of the decomposition nearest to the expected normal, or by that normal at little parallax.
Matrix3d rotation_of(const Pair& pair, const Vector3d& normal) {
  if (!pair.motions.empty()) {
    const HomographyMotion& motion = nearest(pair.motions, normal);
    if (motion.tau.norm() > kFullParallax && angle_deg(motion.normal, normal) < kNormalCapDeg)
      return motion.R_21;
  }
  return rotation_given_normal(pair.H_ji, normal);
}

struct Consensus {
  Vector3d normal;  ///< in the reference frame
  double cost;      ///< mean squared angle of the nearest candidates, weighted by parallax [deg^2]
};

/// Mean shift from one candidate. The twin normal of each decomposition moves with the translation
/// and the true one does not, so the true one gathers candidates at a lower cost.
Consensus gather(std::span<const Pair> pairs, Vector3d normal) {
  double cost = 0;
  for (int round = 0; round < 10; ++round) {
    Vector3d sum = Vector3d::Zero();
    double weights = 0;
    cost = 0;
    for (const Pair& pair : pairs) {
      if (pair.motions.empty()) continue;
      const HomographyMotion& motion = nearest(pair.motions, normal);
      const double angle = angle_deg(motion.normal, normal);
      cost += weight_of(motion) * std::min(angle * angle, kNormalCapDeg * kNormalCapDeg);
      weights += weight_of(motion);
      if (angle < kNormalCapDeg) sum += weight_of(motion) * motion.normal;
    }
    cost /= std::max(weights, 1e-12);
    if (sum.norm() < 1e-12) break;
    normal = sum.normalized();
  }
  return {normal, cost};
}

std::vector<Consensus> consensuses(std::span<const Pair> pairs) {
  std::vector<Consensus> found;
  for (const Pair& pair : pairs) {
    for (const HomographyMotion& seed : pair.motions) found.push_back(gather(pairs, seed.normal));
  }
  std::ranges::stable_sort(found, {}, &Consensus::cost);
  return found;
}

/// Returns another orientation that fits equally well as the best one; null if there is none.
const Consensus* equally_good(const std::vector<Consensus>& found) {
  const Consensus& best = found.front();
  const auto other = std::ranges::find_if(found, [&](const Consensus& one) {
    return angle_deg(one.normal, best.normal) >= kNormalCapDeg &&
           one.cost <= kClearlyWorse * best.cost;
  });
  return other == found.end() ? nullptr : &*other;
}

std::pair<std::vector<Pair>, std::string> decompose_reference_pairs(const Window& window) {
  std::vector<Pair> pairs;
  for (int j = 1; j < window.frame_count(); ++j) {
    auto pair = decompose_pair(window, 0, j);
    if (!pair)
      return {{},
              fmt::format("rotation averaging: too few tracks join frame {} to the reference frame "
                          "(at least {})",
                          window.start + j,
                          kLeastPairTracks)};
    pairs.push_back(std::move(*pair));
  }
  return {std::move(pairs), ""};
}

double disagreement_deg(std::span<const Pair> pairs,
                        const Vector3d& normal,
                        std::span<const Matrix3d> R_wc_given) {
  std::vector<double> angles;
  for (const Pair& pair : pairs) {
    const Matrix3d R_ij = rotation_of(pair, normal).transpose();
    angles.push_back(degrees(so3_log(R_wc_given[pair.j].transpose() * R_ij).norm()));
  }
  return median(std::move(angles));
}

// An error of the normal enters the rotations in proportion to the parallax.
double rotation_sigma_rad(std::span<const Pair> reference_pairs, const Consensus& plane) {
  double parallax = 0;
  for (const Pair& pair : reference_pairs) {
    if (!pair.motions.empty())
      parallax = std::max(parallax, nearest(pair.motions, plane.normal).tau.norm());
  }
  return radians(std::sqrt(plane.cost)) * parallax;
}

std::vector<Matrix3d> rotations_by(std::span<const Pair> reference_pairs, const Vector3d& normal) {
  std::vector<Matrix3d> R_wc{Matrix3d::Identity()};
  for (const Pair& pair : reference_pairs) R_wc.push_back(rotation_of(pair, normal).transpose());
  return R_wc;
}

Rotations rotations_given_plane(const Window& window,
                                std::span<const Pair> reference_pairs,
                                const Consensus& plane,
                                const std::stop_token& stop) {
  const Vector3d& normal = plane.normal;
  std::vector<Matrix3d> R_wc = rotations_by(reference_pairs, normal);
  std::vector<RelativeRotation> relative;
  for (const Pair& pair : reference_pairs) relative.push_back({0, pair.j, R_wc[pair.j]});
  for (int i = 1; i < window.frame_count(); ++i) {
    if (stop.stop_requested()) return {.reason = "stopped", .stopped = true};
    for (const int length : kPairLengths) {
      const int j = i + length;
      if (j >= window.frame_count()) break;
      if (const auto pair = decompose_pair(window, i, j))
        relative.push_back({i, j, rotation_of(*pair, R_wc[i].transpose() * normal).transpose()});
    }
  }
  return {.R_wc = average_rotations(relative, std::move(R_wc)),
          .model = RotationModel::free,
          .sigma_rad = rotation_sigma_rad(reference_pairs, plane)};
}

std::vector<Consensus> plausible_planes(const std::vector<Consensus>& found) {
  std::vector<Consensus> planes;
  for (const Consensus& one : found) {
    const bool seen = std::ranges::any_of(planes, [&](const Consensus& other) {
      return angle_deg(one.normal, other.normal) < kNormalCapDeg;
    });
    if (!seen && one.cost <= kPlausible * found.front().cost) planes.push_back(one);
  }
  return planes;
}

/// Selects the orientation that clearly fits another plane better, and notes how; else nullopt.
std::optional<std::pair<Consensus, std::string>> resolve_by_another_plane(
    const Window& window, std::span<const Pair> pairs, const std::vector<Consensus>& found) {
  const std::vector<Consensus> candidates = plausible_planes(found);
  if (candidates.size() < 2) return std::nullopt;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k) {
    if (k == window.leader) continue;
    Window other = window;
    other.inlier = window.planes[k].inlier;
    other.H_i1 = window.planes[k].H_i1;
    const auto [other_pairs, reason] = decompose_reference_pairs(other);
    if (!reason.empty()) continue;
    std::vector<double> apart_deg(candidates.size(), std::numeric_limits<double>::infinity());
    for (const Consensus& theirs : plausible_planes(consensuses(other_pairs))) {
      const std::vector<Matrix3d> R_wc = rotations_by(other_pairs, theirs.normal);
      for (std::size_t r = 0; r < candidates.size(); ++r)
        apart_deg[r] = std::min(apart_deg[r], disagreement_deg(pairs, candidates[r].normal, R_wc));
    }
    const auto best = std::ranges::min_element(apart_deg);
    const double least_deg = *best;
    const Consensus& plane = candidates[best - apart_deg.begin()];
    *best = std::numeric_limits<double>::infinity();
    const double next_deg = std::ranges::min(apart_deg);
    if (!(next_deg > kClearlyApart * least_deg)) continue;
    return std::pair{
        plane,
        fmt::format("plane {} resolves the ambiguous orientation of plane {}: rotations agree to "
                    "{:.2f} deg, those of the other orientation to {:.2f} deg",
                    k + 1,
                    window.leader + 1,
                    least_deg,
                    next_deg)};
  }
  return std::nullopt;
}

Consensus nearest_plane(std::span<const Pair> pairs,
                        const std::vector<Consensus>& found,
                        std::span<const Matrix3d> R_wc_given) {
  const Consensus* best = &found.front();
  double least_deg = disagreement_deg(pairs, best->normal, R_wc_given);
  for (const Consensus& other : found) {
    if (other.cost > kPlausible * found.front().cost) break;
    if (angle_deg(other.normal, best->normal) < kNormalCapDeg) continue;
    const double other_deg = disagreement_deg(pairs, other.normal, R_wc_given);
    if (other_deg >= least_deg) continue;
    best = &other;
    least_deg = other_deg;
  }
  return *best;
}

}  // namespace

Rotations averaged_rotations(const Window& window,
                             const std::stop_token& stop,
                             std::span<const Matrix3d> R_wc_given) {
  const auto [pairs, reason] = decompose_reference_pairs(window);
  if (!reason.empty()) return {{}, reason};
  const std::vector<Consensus> found = consensuses(pairs);
  if (found.empty())
    return {{}, "rotation averaging: the homographies allow no consistent rotations"};
  if (!R_wc_given.empty())
    return rotations_given_plane(window, pairs, nearest_plane(pairs, found, R_wc_given), stop);
  if (const auto resolved = resolve_by_another_plane(window, pairs, found)) {
    Rotations rotations = rotations_given_plane(window, pairs, resolved->first, stop);
    rotations.note = resolved->second;
    return rotations;
  }
  Rotations rotations = rotations_given_plane(window, pairs, found.front(), stop);
  const Consensus* other = equally_good(found);
  if (other == nullptr || rotations.stopped) return rotations;
  Rotations second = rotations_given_plane(window, pairs, *other, stop);
  if (second.stopped) return second;
  rotations.R_wc_other = std::move(second.R_wc);
  rotations.orientations_apart_deg = angle_deg(other->normal, found.front().normal);
  return rotations;
}

}  // namespace gpo
