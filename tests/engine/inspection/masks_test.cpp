// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "tests/engine/desk.h"
#include "tests/engine/simulated_room.h"
#include "tests/engine/test_folder.h"

#include <numeric>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Vector2d, testing::HasSubstr;

Masks masks_of(const std::string& text) { return with_setting({}, "mask", text).mask; }

TEST(Masks, ContainPixelsOfRectanglesAndPolygons) {
  const Mask rectangle = masks_of("not:100,80,20,40").areas[0];
  EXPECT_TRUE(rectangle.contains(Vector2d(60, 60)));
  EXPECT_FALSE(rectangle.contains(Vector2d(60, 90)));
  EXPECT_FALSE(rectangle.contains(Vector2d(19, 60)));
  EXPECT_EQ(rectangle.area_px2(), 80 * 40);
  // An L, whose bounding box has an empty quarter.
  const Mask polygon = masks_of("plane:0,0,40,0,40,20,20,20,20,40,0,40").areas[0];
  EXPECT_EQ(polygon.kind, MaskKind::plane);
  EXPECT_TRUE(polygon.contains(Vector2d(30, 10)));
  EXPECT_TRUE(polygon.contains(Vector2d(10, 30)));
  EXPECT_FALSE(polygon.contains(Vector2d(30, 30)));
}

TEST(Masks, AreWrittenAsTheyAreRead) {
  const std::string text = "not:100,80.5,20,40/plane:0,0,40,0,40,20";
  EXPECT_EQ(setting_text(with_setting({}, "mask", text), "mask"), text);
  EXPECT_TRUE(masks_of("none").areas.empty());
}

TEST(Masks, RejectTextThatIsNoArea) {
  const auto refusal = [](const std::string& text) {
    return error_of([&] { with_setting({}, "mask", text); });
  };
  EXPECT_THAT(refusal("maybe:1,2,3,4"), HasSubstr("'maybe', expected one of not, plane"));
  EXPECT_THAT(refusal("not:1,2,3"), HasSubstr("'not:1,2,3', expected KIND:X1,Y1,X2,Y2"));
  EXPECT_THAT(refusal("not"), HasSubstr("expected KIND:X1,Y1,X2,Y2 (a rectangle)"));
  EXPECT_THAT(refusal("not:1,2,x,4"), HasSubstr("mask: 'x', expected a number"));
  EXPECT_THAT(refusal("plane:5,5,5,90"), HasSubstr("expected an area of at least one pixel"));
}

TEST(Masks, LeaveOutTracksByTheirPlaceInTheReferenceFrame) {
  Inspector inspector(desk());
  Settings settings{.frames = 12};
  const auto whole = inspector.inspect(settings);
  settings = with_setting(settings, "mask", "not:0,0,320,479");
  const auto without = inspector.inspect(settings);
  EXPECT_EQ(without->tracks, whole->tracks) << "tracks are followed as before";
  int inside = 0, inliers = 0;
  for (int j = 0; j < whole->tracks->track_count(); ++j) {
    const bool in_mask = whole->tracks->raw_px[0](0, j) < 320;
    inside += in_mask && whole->window->inlier[0][j] ? 1 : 0;
    inliers += without->window->inlier[0][j] ? 1 : 0;
    EXPECT_EQ(is_excluded(*without, j), in_mask);
    EXPECT_FALSE(in_mask && without->window->points_px[0].col(j).allFinite());
    const std::string verdict = track_life(*without, j).verdict;
    EXPECT_EQ(verdict.starts_with("in a mask that leaves out its tracks"), in_mask) << verdict;
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(inliers, 10);
  const auto json = to_json(*without);
  EXPECT_EQ(json["settings"]["mask"][0]["kind"], "not");
  EXPECT_EQ(json["settings"]["mask"][0]["corners_raw_px"].dump(), "[[0.0,0.0],[320.0,479.0]]");
  settings = with_default(settings, "mask");
  EXPECT_EQ(inspector.inspect(settings)->window->inlier, whole->window->inlier);
}

/// Tracks of a room with a floor, which has most of them, and a wall.
struct MaskedRoom : testing::Test {
  MaskedRoom()
      : room(simulate_room(
            {.planes = floor_and_walls(), .shares = {0.5, 0.3, 0.0}, .known_exactly = true})) {
    tracks.raw_px = room.window.points_px;
    tracks.ids.resize(room.window.track_count());
    std::iota(tracks.ids.begin(), tracks.ids.end(), 0);
    for (const int plane : room.plane_of_track) on_wall.push_back(plane == 1);
  }
  Window window(Inliers inliers, const std::vector<bool>& on_first_plane) const {
    return make_window(tracks,
                       {640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}},
                       room.window.timestamps_ns,
                       {.inliers = inliers, .on_first_plane = on_first_plane});
  }
  int count(const Window& window, const std::vector<int>& of, int plane) const {
    (void)window;
    return static_cast<int>(
        std::ranges::count_if(of, [&](int j) { return room.plane_of_track[j] == plane; }));
  }

  Room room;
  Tracks tracks;
  std::vector<bool> on_wall;
};

TEST_F(MaskedRoom, HasTheMaskedPlaneFirstThoughAnotherOneHasMoreTracks) {
  const Window usual = window(Inliers::planes, {});
  ASSERT_GE(usual.planes.size(), 2U);
  EXPECT_GT(count(usual, usual.planes[0].tracks, 0), 80) << "the floor has most tracks";
  const Window masked = window(Inliers::planes, on_wall);
  ASSERT_GE(masked.planes.size(), 2U);
  for (const int j : masked.planes[0].tracks) EXPECT_TRUE(on_wall[j]);
  for (const int j : masked.planes[1].tracks) EXPECT_FALSE(on_wall[j]);
  EXPECT_GT(masked.planes[0].tracks.size(), 50U);
  EXPECT_GT(count(masked, masked.planes[1].tracks, 0), 80);
  EXPECT_EQ(masked.leader, 0);
}

TEST_F(MaskedRoom, HasInliersInTheMaskOnlyWithoutPlanes) {
  for (const Inliers inliers : {Inliers::per_frame, Inliers::consistent}) {
    const Window masked = window(inliers, on_wall);
    EXPECT_GT(masked.inlier_count(0), 50);
    for (int j = 0; j < masked.track_count(); ++j)
      EXPECT_FALSE(masked.inlier[5][j] && !on_wall[j]) << j;
  }
}

TEST_F(MaskedRoom, HasNoPlaneIfTheMaskHasTooFewTracks) {
  std::vector<bool> few(on_wall.size(), false);
  std::fill_n(few.begin(), 5, true);
  EXPECT_TRUE(window(Inliers::planes, few).planes.empty());
}

}  // namespace
}  // namespace gpo::test
