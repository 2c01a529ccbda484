// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Minimal solver of relative poses: Nister's five-point algorithm, or the eigensolver of Kneip and
/// Lynen 2013, which optimizes the rotation alone from a guess.
enum class RelativeSolver { five_point, eigensolver };

/// Tracks that frames i and j see.
struct RayPairs {
  Eigen::Matrix3Xd i;      ///< K^-1 p, third coordinate 1, 3 x n
  Eigen::Matrix3Xd j;      ///< 3 x n
  std::vector<int> group;  ///< surface that each track may lie on, counted from 0
};

struct RelativePoseOptions {
  RelativeSolver solver = RelativeSolver::five_point;
  double gate = 0.004;  ///< largest Sampson distance of an inlier, in units of K^-1 p [-]
  Eigen::Matrix3d R_ij_guess = Eigen::Matrix3d::Identity();
  std::uint64_t seed = 1;
};

/// x_i ~ R_ij x_j + s direction; s has either sign if the camera hardly moved.
struct RelativePose {
  Eigen::Matrix3d R_ij;
  Eigen::Vector3d direction;  ///< to camera j, in frame i, unit length, up to its sign
  std::vector<bool> inlier;   ///< one a track
  int inliers = 0;
};

/// Estimates a relative pose by RANSAC over a solver's proposals and refines it by the weighted
/// eigensolver, which minimizes Sampson's error over the inliers. Half of the samples draw from all
/// groups so that a plane with nearly all tracks does not dominate. Returns nullopt if fewer than
/// `kLeastPairRays` agree.
std::optional<RelativePose> relative_pose(const RayPairs& rays, const RelativePoseOptions& options);

inline constexpr int kLeastPairRays = 12;

/// Returns squared first-order distances to the epipolar geometry, one a track (Hartley &
/// Zisserman, 11.9).
Eigen::ArrayXd squared_sampson_distances(const Eigen::Matrix3d& E, const RayPairs& rays);

}  // namespace gpo
