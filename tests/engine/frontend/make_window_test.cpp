// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/make_window.h"

#include "tests/engine/simulated_window.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

// Descriptors are matched wrongly in one frame and rightly in the next; no judging frame sees
// these.
TEST(MakeWindow, AFewWrongMatchesInOneFrameDoNotTakeThatFramesInliers) {
  const auto simulation = test::simulate({.motion = test::Motion::orbit, .frames = 20});
  const Camera camera{.width = 640, .height = 480, .fx = 500, .fy = 500, .cx = 319.5, .cy = 239.5};
  Tracks tracks;
  for (int j = 0; j < simulation.window.track_count(); ++j) tracks.ids.push_back(j);
  tracks.raw_px = simulation.window.points_px;
  for (int j = 0; j < 12; ++j) tracks.raw_px[4].col(10 * j) += Eigen::Vector2d(90 - 15 * j, 8 * j);
  const Window window =
      make_window(tracks, camera, simulation.window.timestamps_ns, {.inliers = Inliers::planes});
  ASSERT_EQ(window.planes.size(), 1U);
  EXPECT_GE(window.inlier_count(4), window.inlier_count(5) - 16);
}

}  // namespace
}  // namespace gpo
