// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/linked_selection.h"

#include "engine/inspection/studies/studies.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/scene/scene_view.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::Contains, testing::ElementsAre;

TEST_F(LinkedSelection, HighlightsTheTrackUnderTheMouseOnly) {
  const int column = lonely_track();
  ASSERT_GE(column, 0);
  point_at(track_on_screen(column));
  EXPECT_EQ(state_.hover.track, inspection_->tracks->ids[column]);
  EXPECT_EQ(highlight_of(state_).hovered, column);
  point_at({100, 300});
  EXPECT_EQ(state_.hover, Hover{});
}

TEST_F(LinkedSelection, ClickSelectsAndControlClickToggles) {
  const int column = lonely_track();
  const std::int64_t id = inspection_->tracks->ids[column];
  click(track_on_screen(column));
  EXPECT_THAT(state_.selection.tracks, ElementsAre(id));
  EXPECT_EQ(state_.selection.focus, id);
  test::hold(true, false);
  click(track_on_screen(column));
  test::hold(false, false);
  EXPECT_EQ(state_.selection, Selection{});
}

TEST_F(LinkedSelection, ShiftDragSelectsARectangle) {
  const Vector2d middle = image().min + image().size / 2;
  select_rectangle(middle - Vector2d(120, 90), middle + Vector2d(120, 90));
  EXPECT_GT(state_.selection.tracks.size(), 3U);
  EXPECT_EQ(state_.view.image_zoom.factor, 1);
  EXPECT_EQ(state_.view.image_zoom.center, Vector2d(0.5, 0.5)) << "must not pan";
}

TEST_F(LinkedSelection, SelectsUndistortedTracksWhereTheyAreShown) {
  const Eigen::AlignedBox2d inside(image().min + Vector2d(20, 20),
                                   image().min + image().size - Vector2d(20, 20));
  const auto moved = [&](int column) {
    state_.view.toggles.undistorted = false;
    const Vector2d recorded = track_on_screen(column);
    state_.view.toggles.undistorted = true;
    const Vector2d shown = track_on_screen(column);
    return inside.contains(shown) ? (shown - recorded).norm() : 0.0;
  };
  int column = 0;
  for (int k = 0; k < inspection_->tracks->track_count(); ++k)
    if (inspection_->tracks->seen(kFrame - kStart, k) && moved(k) > moved(column)) column = k;
  ASSERT_GT(moved(column), 12) << "[px], beyond the reach of a click";
  const Vector2d at = track_on_screen(column);
  select_rectangle(at - Vector2d(6, 6), at + Vector2d(6, 6));
  EXPECT_THAT(state_.selection.tracks, Contains(inspection_->tracks->ids[column]));
}

TEST_F(LinkedSelection, ClickOnAPointOfTheSceneSelectsItsTrack) {
  const int column = lonely_track();
  for (const MapPoint& point : inspection_->initialization->points)
    if (point.track == column) click(on_scene(point.position));
  EXPECT_EQ(state_.selection.focus, inspection_->tracks->ids[column]);
  EXPECT_EQ(state_.hover.track, inspection_->tracks->ids[column]);
}

TEST_F(LinkedSelection, ClickOnACameraGoesToItsFrame) {
  click(on_scene(inspection_->initialization->cameras[3].p_wc));
  EXPECT_EQ(state_.view.frame, kStart + 3);
  EXPECT_TRUE(state_.selection.tracks.empty());
}

TEST_F(LinkedSelection, RightClickInTheSceneOffersToPutTheCubeThere) {
  const Plane& plane = inspection_->initialization->plane;
  const Eigen::Vector3d to = free_place();
  const ScreenRect side = screen_rect(layout_.side);
  ASSERT_TRUE(Eigen::AlignedBox2d(side.min, side.min + side.size).contains(on_scene(to)))
      << on_scene(to).transpose();
  click(on_scene(to), 1);
  EXPECT_FALSE(state_.document.cube_ray) << "a right click moves nothing";
  run_entry(ContextKind::plane, "Put the cube here");
  ASSERT_TRUE(state_.document.cube_ray.has_value());
  const Eigen::Vector3d there = *intersect(plane, Pose{}, *state_.document.cube_ray);
  EXPECT_LT((there - to).norm(), 0.02);  // the mouse is on whole pixels
  Inspection moved = *inspection_;
  move_cubes(moved, *state_.document.cube_ray);
  EXPECT_LT((moved.cube->origin - to).norm(), 0.02);
  EXPECT_EQ(moved.cube->axes, inspection_->cube->axes);
}

/// Adds a wall, plane 2, that faces the reference camera half as far as the floor in the middle of
/// the image. Its inliers are the tracks in the right third.
TEST_F(LinkedSelection, LegendIsInTheMarginAndItsRowsToggleTheirClass) {
  const auto hit = [&](const std::string& action) {
    const auto found = std::ranges::find_if(
        views_->legend_hits, [&](const LegendHit& one) { return one.action == action; });
    return found == views_->legend_hits.end() ? throw std::out_of_range(action) : *found;
  };
  const ImageMapping mapping =
      map_image(state_.document.recording->camera, image(), state_.view.image_zoom);
  const auto click_row = [&](const std::string& action) {
    const ScreenRect row = hit(action).rect;
    EXPECT_LE(row.min.y() + row.size.y(), mapping.origin.y());
    click((row.min + row.size / 2).array().round());
  };
  for (const bool on : {false, true}) {
    click_row("tracks");
    EXPECT_EQ(state_.view.toggles.tracks, on);
    click_row("cube");
    EXPECT_EQ(state_.view.toggles.cube, on);
  }
  EXPECT_TRUE(state_.selection.tracks.empty());
  click_row("legend");
  EXPECT_FALSE(state_.view.toggles.legend);
  EXPECT_TRUE(views_->legend_hits.empty());
}

TEST_F(LinkedSelection, EveryEntryOfAContextMenuIsAnAction) {
  ContextSubject any{
      .kind = ContextKind::track, .ray = Vector3d(0, 0.5, 1), .value = "1", .uncertain = "1 ±2"};
  any.track = inspection_->tracks->ids.front();
  any.plane = 1;
  std::set<std::pair<ContextKind, std::string>> titles;
  for (const ContextEntry& entry : context_entries()) {
    EXPECT_TRUE(titles.emplace(entry.kind, entry.title).second) << entry.title;
    const std::string line = entry.line(state_, any);
    EXPECT_TRUE(line.empty() || match_line(line)) << line;
  }
  EXPECT_EQ(titles.size(), 20U);
}

TEST_F(LinkedSelection, MenusOfNumbersCopyWithAndWithoutUncertainty) {
  const auto line = [&](const char* title, const ContextSubject& of) {
    for (const ContextEntry& entry : context_entries())
      if (entry.kind == of.kind && entry.title == std::string(title)) return entry.line(state_, of);
    return std::string("none");
  };
  const ContextSubject number{
      .kind = ContextKind::number, .value = "0.912", .uncertain = "0.912 ±0.004 rad/s"};
  run_line(state_, line("Copy the value", number));
  EXPECT_EQ(state_.requests.copied, "0.912");
  run_line(state_, line("Copy with its uncertainty", number));
  EXPECT_EQ(state_.requests.copied, "0.912 ±0.004 rad/s");
  EXPECT_EQ(line("Copy with its uncertainty", {.kind = ContextKind::number, .value = "3"}), "");
}

TEST_F(LinkedSelection, SceneIsRenderedAgainWhenTheCubeMoves) {
  const std::size_t renders = views_->scene.renders();
  state_.results.inspection = with_cube(inspection_, Eigen::Vector3d(0.2, 0.1, 1));
  draw();
  EXPECT_EQ(views_->scene.renders(), renders + 1);
}

TEST_F(LinkedSelection, ExcludedTracksAreNoOutliers) {
  Inspection excluding = *inspection_;
  const auto outliers = [&] { return outliers_in_view(state_).size(); };
  const std::size_t before = outliers();
  ASSERT_GT(before, 0U);
  const std::int64_t id = outliers_in_view(state_).front();
  const int column = *column_of(*inspection_->tracks, id);
  excluding.settings.exclude = {id};
  state_.results.inspection = std::make_shared<const Inspection>(excluding);
  EXPECT_EQ(outliers() + 1, before);
  EXPECT_EQ(track_style(*inspection_, kFrame - kStart, column).sign, Sign::cross);
  EXPECT_EQ(track_style(excluding, kFrame - kStart, column).sign, Sign::dot);
}

TEST_F(LinkedSelection, LostTracksHaveTheirSignWhereTheyWereLastSeen) {
  const Inspection& inspection = *inspection_;
  constexpr int kLate = 24;  // in the window
  apply(state_, GoToFrame{kStart + kLate});
  draw_times(3);
  const ImageMapping mapping =
      map_image(state_.document.recording->camera, image(), state_.view.image_zoom);
  const auto on_screen = [&](int column) {
    const auto place = place_of_sign(inspection, kLate, column);
    return place ? std::optional(to_screen(mapping, *place)) : std::nullopt;
  };
  const auto is_alone = [&](int column) {
    for (int other = 0; other < inspection.tracks->track_count(); ++other)
      if (const auto at = on_screen(other);
          other != column && at && (*at - *on_screen(column)).norm() < 12)
        return false;
    return true;
  };
  int lost = 0, pointed_at = 0;
  for (int column = 0; column < inspection.tracks->track_count(); ++column) {
    const SignStyle look = track_style(inspection, kLate, column);
    EXPECT_EQ(look.sign == Sign::diamond, !inspection.tracks->seen(kLate, column)) << column;
    if (look.sign != Sign::diamond) continue;
    EXPECT_EQ(look.rgb, color_of(Role::lost));
    ++lost;
    int last = kLate;
    while (!inspection.tracks->seen(last, column)) --last;
    ASSERT_EQ(place_of_sign(inspection, kLate, column),
              inspection.tracks->raw_px[last].col(column));
    if (!is_alone(column)) continue;
    ++pointed_at;
    point_at(*on_screen(column));
    EXPECT_EQ(state_.hover.track, inspection.tracks->ids[column]);
  }
  EXPECT_EQ(lost, lost_count(*inspection.window, kLate));
  EXPECT_GT(pointed_at, 3);
  EXPECT_FALSE(place_of_sign(inspection, 30, 0)) << "outside of the window";
}

TEST_F(LinkedSelection, RightClickInTheImageOffersToPutTheCubeThere) {
  const Vector2d at = (image().min + 0.6 * image().size).array().floor();
  click(at, 1);
  EXPECT_FALSE(state_.document.cube_ray);
  run_entry(ContextKind::plane, "Put the cube here");
  ASSERT_TRUE(state_.document.cube_ray.has_value());
  const ImageMapping mapping =
      map_image(state_.document.recording->camera, image(), state_.view.image_zoom);
  const auto ray = point_on_plane(*inspection_,
                                  kFrame - inspection_->window->start,
                                  to_image(mapping, at),
                                  inspection_->initialization->plane);
  EXPECT_LT((ray->normalized() - *state_.document.cube_ray).norm(), 1e-8);
}

TEST_F(LinkedSelection, MenuOfAPixelPicksItAndOffersScaleAndOriginForTwoPoints) {
  constexpr const char* kScale = "Set the scale from two points ...";
  for (const int x : {60, 160}) {
    click(image().min + Vector2d(x, 200), 1);
    EXPECT_EQ(line_of_entry(ContextKind::point, kScale), "");
    run_entry(ContextKind::point, "Pick this point (Alt+click)");
  }
  EXPECT_EQ(state_.selection.points_px.size(), 2U);
  EXPECT_THAT(state_.messages.text, testing::HasSubstr("right-click the image"));
  click(image().min + Vector2d(120, 200), 1);
  EXPECT_EQ(line_of_entry(ContextKind::point, kScale), "palette set-scale");
  EXPECT_EQ(line_of_entry(ContextKind::point, "Set the origin and x axis"), "set-origin");
}

}  // namespace
}  // namespace gpo::test
