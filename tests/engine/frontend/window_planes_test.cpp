// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/inliers.h"
#include "tests/engine/simulated_room.h"

#include <algorithm>
#include <limits>
#include <map>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

/// Returns the largest share of a plane's tracks that are on one true plane.
double purity(const Room& room, const std::vector<int>& tracks) {
  std::map<int, int> counts;
  for (const int j : tracks) ++counts[room.plane_of_track[j]];
  int most = 0;
  for (const auto& [plane, count] : counts)
    if (plane >= 0) most = std::max(most, count);
  return static_cast<double>(most) / static_cast<double>(tracks.size());
}

TEST(WindowPlanes, AreFloorAndWallsOfARoom) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Room room =
        simulate_room({.planes = floor_and_walls(), .shares = {0.4, 0.25, 0.2}, .seed = seed});
    ASSERT_EQ(room.window.planes.size(), 3) << seed;
    for (const WindowPlane& plane : room.window.planes)
      EXPECT_GT(purity(room, plane.tracks), 0.85) << seed;
    EXPECT_GE(room.window.planes[0].tracks.size(), room.window.planes[1].tracks.size());
  }
}

TEST(WindowPlanes, AreDisjointAndSorted) {
  const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.4, 0.3, 0.3}});
  std::vector<int> all;
  for (const WindowPlane& plane : room.window.planes) {
    EXPECT_TRUE(std::ranges::is_sorted(plane.tracks));
    all.insert(all.end(), plane.tracks.begin(), plane.tracks.end());
  }
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

TEST(WindowPlanes, AreNotFoundInACloud) {
  int refused = 0;
  constexpr int kSeeds = 500;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Room room =
        simulate_room({.farthest = 1.5 + 1.5 * static_cast<double>(seed) / kSeeds, .seed = seed});
    refused += room.window.planes.empty() ? 1 : 0;
  }
  EXPECT_GE(refused, 475);
}

TEST(WindowPlanes, AreFoundFromAQuarterOfTheTracks) {
  int found = 0;
  constexpr int kSeeds = 500;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.25}, .seed = seed});
    found += !room.window.planes.empty() && purity(room, room.window.planes[0].tracks) > 0.8;
  }
  EXPECT_GE(found, 475);
}

TEST(WindowPlanes, SeparateTwoLayers) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Eigen::Vector3d m = floor_and_walls()[0];
    const Room room = simulate_room({.planes = {m, m / 1.3}, .shares = {0.55, 0.45}, .seed = seed});
    ASSERT_EQ(room.window.planes.size(), 2) << seed;
    EXPECT_GT(purity(room, room.window.planes[0].tracks), 0.95) << seed;
    EXPECT_GT(purity(room, room.window.planes[1].tracks), 0.95) << seed;
  }
}

TEST(WindowPlanes, JudgeATrackByTheFramesThatSeeIt) {
  Room room = simulate_room({.planes = floor_and_walls(), .shares = {1}});
  std::vector<Eigen::Matrix2Xd> points = room.window.points_px;
  for (std::size_t i = points.size() / 2; i < points.size(); ++i)
    points[i].col(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  const TrackPlanes found = window_planes(points);
  ASSERT_EQ(found.planes.size(), 1);
  EXPECT_TRUE(std::ranges::binary_search(found.planes[0], 3));
}

// RMS transfer errors are 1.4 px, the gate is 2 px. With 1 px of noise they are at the gate, and
// one window in eight is rejected.
TEST(WindowPlanes, AreFoundFromFewNoisyTracks) {
  int found = 0;
  constexpr int kSeeds = 50;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Room room = simulate_room(
        {.tracks = 36, .noise_px = 0.7, .planes = floor_and_walls(), .shares = {1}, .seed = seed});
    found += room.window.planes.empty() ? 0 : 1;
  }
  EXPECT_GE(found, 48);
}

TEST(WindowPlanes, ReportTheLargestRejectedSet) {
  const Room room = simulate_room({.seed = 3});
  ASSERT_TRUE(room.window.planes.empty());
  EXPECT_LT(room.window.largest_refused, 100);
}

}  // namespace
}  // namespace gpo::test
