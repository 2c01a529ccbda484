// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/homography_rotations.h"

#include "engine/frontend/rotation_averaging.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/homography_decomposition.h"
#include "engine/geometry/nearest_rotation.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kLeastPairTracks = 12;
constexpr int kLongestPair = 20;  // frames apart; pairs with the reference frame are all taken
constexpr double kNormalCapDeg =
    10;  // a candidate farther from the common normal is the false twin
constexpr double kClearlyWorse = 2.25;  // cost of a second plane: else the two cannot be told apart
constexpr double kPlausible = 9;        // cost of another plane that may still be the right one
constexpr double kClearlyApart = 2;     // rotations of another reading, in those of the right one
constexpr double kFullParallax = 0.15;  // |tau| from which on a decomposition counts fully

struct Pair {
  int i;
  int j;
  Matrix3d H_ji;                          // Euclidean: rays of i to rays of j, any scale
  std::vector<HomographyMotion> motions;  // from i to j; empty where the camera hardly moved
};

/// Candidates from the tracks that both frames see as inliers.
std::optional<Pair> decompose_pair(const Window& window, int i, int j) {
  std::vector<int> common;
  for (int k = 0; k < window.track_count(); ++k) {
    const bool in_i = i == 0 ? window.points_px[0].col(k).allFinite() : bool{window.inlier[i][k]};
    if (in_i && window.inlier[j][k]) common.push_back(k);
  }
  if (static_cast<int>(common.size()) < kLeastPairTracks) return std::nullopt;
  const Matrix2Xd from = window.points_px[i](Eigen::all, common);
  const Matrix2Xd to = window.points_px[j](Eigen::all, common);
  const auto fitted = fit_homography(from, to);
  if (!fitted) return std::nullopt;
  const Matrix3d H = refine_homography(*fitted, from, to);
  return Pair{i, j, window.K.inverse() * H * window.K, decompose_homography(H, window.K, from)};
}

/// The rotation R_ji when the plane's normal (in frame i) is known: H' = lambda R (I - tau n^T)
/// leaves the directions on the plane to R alone. Exact without noise; an error of the normal
/// enters in proportion to |tau|, so that it suits pairs of little parallax, where a decomposition
/// is ill-posed.
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

/// R_ji of a pair: of the decomposition whose normal (frame i) is the expected one where it is
/// sharp, else from the expected normal itself.
Matrix3d rotation_of(const Pair& pair, const Vector3d& normal) {
  if (!pair.motions.empty()) {
    const HomographyMotion& motion = nearest(pair.motions, normal);
    if (motion.tau.norm() > kFullParallax && angle_deg(motion.normal, normal) < kNormalCapDeg) {
      return motion.R_21;
    }
  }
  return rotation_given_normal(pair.H_ji, normal);
}

/// A plane's normal in the reference frame, and how far the decompositions' nearest candidates are
/// from it: a mean square angle, weighted by parallax [deg^2].
struct Consensus {
  Vector3d normal;
  double cost;
};

/// Mean shift from one candidate. The false twin of each decomposition moves with the translation,
/// the true one does not, so that it gathers at lower cost.
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

/// All points at which candidates gather, the best first.
std::vector<Consensus> consensuses(std::span<const Pair> pairs) {
  std::vector<Consensus> found;
  for (const Pair& pair : pairs) {
    for (const HomographyMotion& seed : pair.motions) found.push_back(gather(pairs, seed.normal));
  }
  std::ranges::stable_sort(found, {}, &Consensus::cost);
  return found;
}

/// Why no one plane can be told from the homographies; nothing where it can.
std::optional<std::string> reason_to_doubt(const std::vector<Consensus>& found) {
  if (found.empty()) return "rotation averaging: the homographies allow no consistent rotations";
  for (const Consensus& other : found) {
    const double apart_deg = angle_deg(other.normal, found.front().normal);
    if (apart_deg < kNormalCapDeg || other.cost > kClearlyWorse * found.front().cost) continue;
    return fmt::format(
        "rotation averaging: two planes, {:.0f} degrees apart, explain the homographies alike; a "
        "gyroscope "
        "or more sideways motion would tell",
        apart_deg);
  }
  return std::nullopt;
}

/// Decomposed pairs of the reference frame with each other frame, or why there are none.
struct ReferencePairs {
  std::vector<Pair> pairs;
  std::string reason;
};

ReferencePairs decompose_reference_pairs(const Window& window) {
  ReferencePairs result;
  for (int j = 1; j < window.frame_count(); ++j) {
    auto pair = decompose_pair(window, 0, j);
    if (!pair) {
      return {{},
              fmt::format("rotation averaging: too few tracks join frame {} to the reference frame "
                          "(at least {})",
                          window.start + j,
                          kLeastPairTracks)};
    }
    result.pairs.push_back(std::move(*pair));
  }
  return result;
}

/// How far the rotations that go with a normal are from given ones, the median over the pairs
/// [deg].
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

/// An error of the normal enters the rotations in proportion to the parallax.
double rotation_sigma_rad(std::span<const Pair> reference_pairs, const Consensus& plane) {
  double parallax = 0;
  for (const Pair& pair : reference_pairs) {
    if (!pair.motions.empty())
      parallax = std::max(parallax, nearest(pair.motions, plane.normal).tau.norm());
  }
  return radians(std::sqrt(plane.cost)) * parallax;
}

/// Rotations of all frames, once the plane is chosen.
Rotations rotations_given_plane(const Window& window,
                                std::span<const Pair> reference_pairs,
                                const Consensus& plane,
                                const std::stop_token& stop) {
  const Vector3d& normal = plane.normal;
  std::vector<Matrix3d> R_wc{Matrix3d::Identity()};
  std::vector<RelativeRotation> relative;
  for (const Pair& pair : reference_pairs) {
    relative.push_back({pair.i, pair.j, rotation_of(pair, normal).transpose()});
    R_wc.push_back(relative.back().R_ij);
  }
  for (int i = 1; i < window.frame_count(); ++i) {
    if (stop.stop_requested()) return {.reason = "stopped", .stopped = true};
    for (int j = i + 1; j < window.frame_count() && j - i <= kLongestPair; ++j) {
      const auto pair = decompose_pair(window, i, j);
      if (pair)
        relative.push_back({i, j, rotation_of(*pair, R_wc[i].transpose() * normal).transpose()});
    }
  }
  return {average_rotations(relative, std::move(R_wc)),
          "",
          RotationModel::free,
          std::nullopt,
          rotation_sigma_rad(reference_pairs, plane)};
}

/// Of those at which candidates gather at a plausible cost, each once.
std::vector<Consensus> decompositions_of(const std::vector<Consensus>& found) {
  std::vector<Consensus> readings;
  for (const Consensus& one : found) {
    const bool seen = std::ranges::any_of(readings, [&](const Consensus& other) {
      return angle_deg(one.normal, other.normal) < kNormalCapDeg;
    });
    if (!seen && one.cost <= kPlausible * found.front().cost) readings.push_back(one);
  }
  return readings;
}

std::vector<Matrix3d> rotations_by(std::span<const Pair> reference_pairs, const Vector3d& normal) {
  std::vector<Matrix3d> R_wc{Matrix3d::Identity()};
  for (const Pair& pair : reference_pairs) R_wc.push_back(rotation_of(pair, normal).transpose());
  return R_wc;
}

/// A reading of the leading plane, and what told it.
struct Told {
  Consensus plane;
  std::string note;
};

/// Two planes that turn with one camera: of the leading plane's readings the one whose rotations
/// another plane's homographies allow, too. Nothing where there is one reading only, no other
/// plane, or none that tells them apart clearly.
std::optional<Told> told_by_another_plane(const Window& window,
                                          std::span<const Pair> pairs,
                                          const std::vector<Consensus>& found) {
  const std::vector<Consensus> readings = decompositions_of(found);
  if (readings.size() < 2) return std::nullopt;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k) {
    if (k == window.leader) continue;
    Window other = window;
    other.inlier = window.planes[k].inlier;
    other.H_i1 = window.planes[k].H_i1;
    const auto [other_pairs, reason] = decompose_reference_pairs(other);
    if (!reason.empty()) continue;
    std::vector<double> apart_deg(readings.size(), std::numeric_limits<double>::infinity());
    for (const Consensus& theirs : decompositions_of(consensuses(other_pairs))) {
      const std::vector<Matrix3d> R_wc = rotations_by(other_pairs, theirs.normal);
      for (std::size_t r = 0; r < readings.size(); ++r)
        apart_deg[r] = std::min(apart_deg[r], disagreement_deg(pairs, readings[r].normal, R_wc));
    }
    const auto best = std::ranges::min_element(apart_deg);
    const double least_deg = *best;
    const Consensus& reading = readings[best - apart_deg.begin()];
    *best = std::numeric_limits<double>::infinity();
    const double next_deg = std::ranges::min(apart_deg);
    if (!(next_deg > kClearlyApart * least_deg)) continue;
    return Told{reading,
                fmt::format("of the two readings of plane {}, plane {} tells the right one: its "
                            "rotations agree to {:.2f} deg, the other's to {:.2f} deg",
                            window.leader + 1,
                            k + 1,
                            least_deg,
                            next_deg)};
  }
  return std::nullopt;
}

}  // namespace

Rotations averaged_rotations(const Window& window, const std::stop_token& stop) {
  const auto [pairs, reason] = decompose_reference_pairs(window);
  if (!reason.empty()) return {{}, reason};
  const std::vector<Consensus> found = consensuses(pairs);
  if (const auto told = told_by_another_plane(window, pairs, found)) {
    Rotations rotations = rotations_given_plane(window, pairs, told->plane, stop);
    rotations.note = told->note;
    return rotations;
  }
  if (auto doubt = reason_to_doubt(found)) return {{}, *doubt};
  return rotations_given_plane(window, pairs, found.front(), stop);
}

Rotations averaged_rotations(const Window& window,
                             std::span<const Matrix3d> R_wc_given,
                             const std::stop_token& stop) {
  const auto [pairs, reason] = decompose_reference_pairs(window);
  if (!reason.empty()) return {{}, reason};
  const std::vector<Consensus> found = consensuses(pairs);
  if (found.empty()) return {{}, *reason_to_doubt(found)};
  // Twins at which few candidates gather are no planes at all.
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
  return rotations_given_plane(window, pairs, *best, stop);
}

}  // namespace gpo
