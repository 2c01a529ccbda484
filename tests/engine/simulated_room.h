// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace gpo::test {

/// Options of a room, in the world of the reference camera, whose distance from the first plane
/// is 1.
struct RoomOptions {
  Motion motion = Motion::orbit;
  int frames = 20;
  int tracks = 200;
  double travel = 0.3;
  double noise_px = 0.2;                     ///< on each coordinate, in all frames
  std::vector<Eigen::Vector3d> planes = {};  ///< m = n / d of each plane
  /// Share of the tracks on each plane; the others are at random depths from `nearest` to
  /// `farthest`.
  std::vector<double> shares = {};
  double nearest = 1;
  double farthest = 3;
  /// Returns 1 / z of a surface along a ray (x, y, 1); null: random depths.
  std::function<double(const Eigen::Vector3d&)> surface = nullptr;
  /// Uses the true planes with all their tracks, not those that the front end finds.
  bool known_exactly = false;
  std::uint64_t seed = 1;
};

struct Room {
  Window window;  ///< by the front end with `Inliers::planes`; rotations are the true ones
  std::vector<Pose> cameras;
  std::vector<Eigen::Vector3d> planes;
  std::vector<int> plane_of_track;  ///< -1: none
};

/// Returns a floor, a wall ahead and a wall to the right.
std::vector<Eigen::Vector3d> floor_and_walls();

Room simulate_room(const RoomOptions& options);

}  // namespace gpo::test
