// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/image/image_view.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Corners = std::array<Vector3d, 8>;

Corners cube_of(const Inspection& inspection) {
  return cube_corners(*inspection.cube, cube_side(inspection, 0));
}

Vector3d middle_of(const Corners& corners) { return (corners[0] + corners[7]) / 2; }

Vector2d seen_at(const Inspection& inspection, const Vector3d& point_w) {
  const Eigen::Matrix3d K = inspection.window->K;
  return (K * to_camera(inspection.initialization->cameras[0], point_w)).hnormalized();
}

/// With a second plane across the reference camera's view, so many times as far away as the cube,
/// told by the tracks for which `on_it` holds of where they and the cube are [px].
template <class OnIt>
Inspection with_plane_across(double times_as_far, OnIt&& on_it) {
  Inspection inspection = made_inspection();
  const Vector3d middle = middle_of(cube_of(inspection));
  auto window = std::make_shared<Window>(*inspection.window);
  window->planes.resize(2);
  std::vector<bool> agrees(window->track_count());
  for (int j = 0; j < window->track_count(); ++j) {
    agrees[j] = on_it(Vector2d(window->points_px[0].col(j)), seen_at(inspection, middle));
    if (agrees[j]) window->planes[1].tracks.push_back(j);
  }
  window->planes[1].inlier.assign(window->frame_count(), agrees);
  for (auto& inlier : window->inlier)
    for (const int j : window->planes[1].tracks) inlier[j] = false;
  window->planes[0].inlier = window->inlier;
  auto initialization = std::make_shared<Initialization>(*inspection.initialization);
  initialization->planes.resize(2);
  initialization->planes[1].number = 1;
  initialization->planes[1].plane = {-Vector3d::UnitZ(), times_as_far * middle.z()};
  inspection.window = window;
  inspection.initialization = initialization;
  return inspection;
}

bool around(const Vector2d& track, const Vector2d& cube) { return (track - cube).norm() < 150; }

TEST(Occluders, AreNearerPlanesBetweenTheirTracks) {
  const Inspection nearer = with_plane_across(0.5, around);
  const auto found = occluders(nearer, 0, cube_of(nearer));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].plane, 1);
  ASSERT_FALSE(found[0].triangles_raw_px.empty());
  const auto& all_px = nearer.tracks->raw_px[0];
  for (const auto& triangle : found[0].triangles_raw_px) {
    for (int k = 0; k < 3; ++k) {
      const auto is_corner = [&](int track) {
        return (all_px.col(track) - triangle[k]).norm() < 1e-3;
      };
      EXPECT_TRUE(std::ranges::any_of(nearer.window->planes[1].tracks, is_corner));
      EXPECT_LE((triangle[k] - triangle[(k + 1) % 3]).norm(),
                0.15 * nearer.recording->camera.width + 1e-3);
    }
  }
}

TEST(Occluders, LeaveOutWhereTracksElsewhereAreSeenBetween) {
  int count = 0;
  const Inspection gaps =
      with_plane_across(0.5, [&count](const Vector2d& track, const Vector2d& cube) {
        return around(track, cube) && count++ % 3 != 0;
      });
  const auto found = occluders(gaps, 0, cube_of(gaps));
  ASSERT_EQ(found.size(), 1U);
  const auto contains = [](const std::array<Vector2d, 3>& t, const Vector2d& p) {
    Eigen::Matrix2d sides;
    sides << t[1] - t[0], t[2] - t[0];
    const Vector2d weights = sides.inverse() * (p - t[0]);
    return weights.x() > 1e-3 && weights.y() > 1e-3 && weights.sum() < 1 - 1e-3;
  };
  for (int track = 0; track < gaps.tracks->track_count(); ++track) {
    if (gaps.window->planes[1].inlier[0][track] || !gaps.tracks->seen(0, track)) continue;
    for (const auto& triangle : found[0].triangles_raw_px)
      EXPECT_FALSE(contains(triangle, gaps.tracks->raw_px[0].col(track))) << track;
  }
}

TEST(Occluders, AreNotWhatIsBehindTheCubeBesideItOrAcrossIt) {
  for (const double times_as_far : {3.0, 1.0}) {
    const Inspection inspection = with_plane_across(times_as_far, around);
    EXPECT_TRUE(occluders(inspection, 0, cube_of(inspection)).empty()) << times_as_far;
  }
  const Inspection beside = with_plane_across(
      0.5, [](const Vector2d& track, const Vector2d& cube) { return track.x() < cube.x() - 120; });
  ASSERT_GE(beside.window->planes[1].tracks.size(), 3U);
  EXPECT_TRUE(occluders(beside, 0, cube_of(beside)).empty());
  const Inspection alone = made_inspection();
  EXPECT_TRUE(occluders(alone, 0, cube_of(alone)).empty());
}

}  // namespace
}  // namespace gpo
