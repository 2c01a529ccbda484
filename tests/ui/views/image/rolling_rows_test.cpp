// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/window/tracks.h"
#include "tests/ui/made_inspection.h"
#include "ui/views/image/image_geometry.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

/// Moves the tracks to where a rolling shutter sees them, with the motion in between.
void roll(Inspection& inspection, double row_delay_s) {
  Initialization result = *inspection.initialization;
  result.row_delay_s = row_delay_s;
  inspection.initialization = std::make_shared<const Initialization>(result);
  inspection.row_motions = row_motions(*inspection.window, result);
  auto tracks = std::make_shared<Tracks>(*inspection.tracks);
  for (int i = 0; i < tracks->frame_count(); ++i) {
    const RollingCamera rolling = rolling_camera(inspection, i);
    for (int j = 0; j < tracks->track_count(); ++j) {
      const Vector2d raw_px = tracks->raw_px[i].col(j);
      const Vector3d ray = inspection.window->K.inverse() *
                           undistort(inspection.recording->camera, raw_px).homogeneous();
      if (const auto point = intersect(result.plane, result.cameras[i], ray))
        tracks->raw_px[i].col(j) = project(rolling, to_camera(result.cameras[i], *point));
    }
  }
  inspection.tracks = tracks;
}

TEST(RollingRows, MoveResidualsAndCubes) {
  const Inspection still = made_inspection();
  Inspection rolling = still;
  roll(rolling, 6e-5);
  const double side = 0.3;
  for (const int frame : {0, 12, 29}) {
    const auto before = residual_vectors(still, frame), after = residual_vectors(rolling, frame);
    ASSERT_EQ(before.size(), after.size());
    double moved_px = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const Vector2d error = before[k].predicted_px - before[k].observed_px;
      EXPECT_LT((after[k].predicted_px - after[k].observed_px - error).norm(), 0.05);
      moved_px = std::max(moved_px, (after[k].observed_px - before[k].observed_px).norm());
    }
    EXPECT_GT(moved_px, 1);
    const CubeImage flat = *estimated_cube(still, frame, {side});
    const CubeImage bent = *estimated_cube(rolling, frame, {side});
    const RollingCamera camera = rolling_camera(rolling, frame);
    for (std::size_t k = 0; k < flat.edges.size(); ++k) {
      if (flat.edges[k].raw_px.empty()) continue;
      const Vector2d px = bent.edges[k].raw_px.front();
      const Vector3d corner = cube_corners(*rolling.cube, side)[flat.edges[k].corners[0]];
      const Pose at_row = rolling.initialization->cameras[frame] * pose_at_row(camera, px);
      EXPECT_LT((project(rolling.recording->camera, to_camera(at_row, corner)) - px).norm(), 1e-2);
    }
  }
}

TEST(RollingRows, TransferErrorsAreThoseThatSelectedTheInliers) {
  const Inspection still = made_inspection();
  Inspection rolling = still;
  roll(rolling, 6e-5);
  auto window = std::make_shared<Window>(*still.window);
  for (int i = 0; i < window->frame_count(); ++i)
    for (int j = 0; j < window->track_count(); ++j)
      window->points_px[i].col(j) =
          undistort(rolling.recording->camera, rolling.tracks->raw_px[i].col(j));
  rolling.window = window;
  double most_px = 0;
  for (const bool known : {false, true}) {
    if (known) rolling.selection = still.window;
    for (int column = 0; column < 40; ++column) {
      const TrackLife expected = track_life(still, column), life = track_life(rolling, column);
      ASSERT_EQ(life.frames.size(), expected.frames.size());
      for (std::size_t i = 1; i < life.frames.size(); ++i) {
        const double px = *life.frames[i].transfer_px - *expected.frames[i].transfer_px;
        if (known) EXPECT_LT(std::abs(px), 1e-6);
        most_px = std::max(most_px, std::abs(px));
      }
    }
    EXPECT_GT(most_px, 0.5) << "the tracks as they are";
  }
}

}  // namespace
}  // namespace gpo
