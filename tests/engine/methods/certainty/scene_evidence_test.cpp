// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/window_evidence.h"
#include "tests/engine/simulated_room.h"

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

std::optional<SceneCriterion> criterion_of(const Room& room) {
  return scene_criterion(room.window, room.cameras, 0.2);
}

TEST(SceneEvidence, PlanesAreTheBetterDescriptionOfPlanes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto flat = criterion_of(
        simulate_room({.planes = floor_and_walls(), .shares = {0.6, 0.4}, .seed = seed}));
    ASSERT_TRUE(flat);
    EXPECT_LT(flat->planes, flat->free_points) << seed;
  }
}

TEST(SceneEvidence, FreePointsAreTheBetterDescriptionOfMostlyFreePoints) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.3}, .seed = seed});
    const auto rough = criterion_of(room);
    if (room.window.planes.empty()) continue;
    ASSERT_TRUE(rough);
    EXPECT_LT(rough->free_points, rough->planes) << seed;
  }
}

TEST(SceneEvidence, OfNoPlaneIsNone) {
  const Room cloud = simulate_room({.seed = 3});
  ASSERT_TRUE(cloud.window.planes.empty());
  EXPECT_FALSE(criterion_of(cloud));
  EXPECT_EQ(scene_of(cloud.window), SceneKind::no_plane);
}

TEST(SceneEvidence, TellsSharesAndStability) {
  const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.6, 0.4}});
  EXPECT_EQ(scene_of(room.window), SceneKind::several_planes);
  ASSERT_EQ(room.window.planes.size(), 2U);
  for (const WindowPlane& plane : room.window.planes) {
    EXPECT_GT(static_cast<double>(plane.tracks.size()) / room.window.track_count(), 0.25);
    EXPECT_GT(plane.image_share, 0.3);  // tracks are all over the picture
    EXPECT_LE(plane.image_share, 1);
    EXPECT_GT(plane.stability, 0.9);
  }
}

}  // namespace
}  // namespace gpo::test
