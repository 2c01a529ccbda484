// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/chosen_world.h"
#include "engine/inspection/studies/studies.h"
#include "tests/ui/window_test.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/scene/scene_view.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector2d, testing::Contains, testing::ElementsAre;

class LinkedSelection : public test::WindowTest {
 protected:
  LinkedSelection() {
    open(made_inspection());
    applies_ = true;
    apply(state_, GoToFrame{kFrame});
    draw_times(3);
  }
  void point_at(const Vector2d& at) {
    WindowTest::point_at(static_cast<float>(at.x()), static_cast<float>(at.y()));
  }
  void click(const Vector2d& at, int button = 0) {
    WindowTest::click(static_cast<float>(at.x()), static_cast<float>(at.y()), button);
    draw_times(40);  // the next click is no double click
  }
  void select_rectangle(const Vector2d& a, const Vector2d& b) {
    test::hold(false, true);
    point_at(a);
    press(true);
    point_at(b);
    press(false);
    test::hold(false, false);
  }

  const ContextSubject& subject(ContextKind kind) const {
    const auto found = std::ranges::find(views_->context, kind, &ContextSubject::kind);
    return found == views_->context.end() ? throw std::out_of_range("no such menu") : *found;
  }
  /// Returns the line that an entry of the open context menu runs; empty if it is not available.
  std::string line_of_entry(ContextKind kind, const std::string& title) const {
    for (const ContextEntry& entry : context_entries())
      if (entry.kind == kind && entry.title == title) return entry.line(state_, subject(kind));
    throw std::out_of_range("no such entry");
  }
  void run_entry(ContextKind kind, const std::string& title) {
    run_line(state_, line_of_entry(kind, title));
  }

  ScreenRect image() const { return screen_rect(layout_.image); }
  Vector2d track_on_screen(int column) const {
    const ImageMapping mapping = map_image(state_.document.recording->camera,
                                           image(),
                                           state_.view.image_zoom,
                                           state_.view.toggles.undistorted);
    return to_screen(mapping, inspection_->tracks->raw_px[kFrame - kStart].col(column));
  }
  OrbitCamera camera() const {
    return default_scene_camera(
        *inspection_, cube_side(*inspection_, 0), layout_.side.width / layout_.side.height);
  }
  Vector2d on_scene(const Eigen::Vector3d& point) const {
    return *on_screen(camera(), point, screen_rect(layout_.side));
  }
  /// Returns a track that has no neighbors in the image and in the scene; -1 if there is none.
  int lonely_track() const {
    const auto& points = inspection_->initialization->points;
    const auto seen = [&](int track) { return inspection_->tracks->seen(kFrame - kStart, track); };
    for (const MapPoint& one : points) {
      bool alone = seen(one.track);
      for (int other = 0; other < inspection_->tracks->track_count() && alone; ++other)
        alone = other == one.track || !seen(other) ||
                (track_on_screen(one.track) - track_on_screen(other)).norm() > 25;
      for (const MapPoint& other : points)
        alone = alone && (other.track == one.track ||
                          (on_scene(one.position) - on_scene(other.position)).norm() > 16);
      if (alone) return one.track;
    }
    return -1;
  }

  /// Returns a point on the plane beside the cube that is far from points and cameras in the scene.
  Eigen::Vector3d free_place() const {
    const CubeAnchor& cube = *inspection_->cube;
    const Initialization& result = *inspection_->initialization;
    for (double x = -0.4; x < 0.4; x += 0.01)
      for (double y = -0.4; y < 0.4; y += 0.01) {
        const Eigen::Vector3d to = cube.origin + x * cube.axes.col(0) + y * cube.axes.col(1);
        const auto near = [&](const Eigen::Vector3d& other) {
          return (on_scene(to) - on_scene(other)).norm() < 11;
        };
        if (std::ranges::none_of(result.points, near, &MapPoint::position) &&
            std::ranges::none_of(result.cameras, near, &Pose::p_wc))
          return to;
      }
    ADD_FAILURE() << "no free place";
    return cube.origin;
  }

  static constexpr int kStart = 5, kFrame = 20;
};

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
Inspection with_wall(Inspection inspection) {
  auto window = std::make_shared<Window>(*inspection.window);
  window->planes.resize(2);
  std::vector<bool> agrees(window->track_count());
  for (int j = 0; j < window->track_count(); ++j) {
    agrees[j] = window->points_px[0](0, j) > 427;
    if (agrees[j]) window->planes[1].tracks.push_back(j);
  }
  window->planes[1].inlier.assign(window->frame_count(), agrees);
  for (auto& inlier : window->inlier)
    for (const int j : window->planes[1].tracks) inlier[j] = false;
  window->planes[0].inlier = window->inlier;
  auto result = std::make_shared<Initialization>(*inspection.initialization);
  result->planes.resize(2);
  result->planes[0].plane = result->plane;
  result->planes[1].number = 1;
  result->planes[1].plane = {-Eigen::Vector3d::UnitZ(), 0.5};
  inspection.window = window;
  inspection.initialization = result;
  inspection.other_cubes = place_other_cubes(inspection);
  return inspection;
}

class SceneWithAWall : public LinkedSelection {
 protected:
  SceneWithAWall() {
    open(with_wall(made_inspection()));
    apply(state_, GoToFrame{kFrame});
    draw_times(3);
  }
  Vector2d track_of_the_wall() const {
    for (const int column : inspection_->window->planes[1].tracks)
      if (inspection_->tracks->seen(kFrame - kStart, column)) return track_on_screen(column);
    return {};
  }
  std::shared_ptr<const Inspection> moved() const {
    return with_cube(inspection_, state_.document.cube_ray, state_.document.other_cube_rays);
  }
};

TEST_F(SceneWithAWall, MenuOfTheWallInTheImagePutsTheCubeOntoIt) {
  click(track_of_the_wall(), 1);
  EXPECT_TRUE(state_.document.other_cube_rays.empty());
  run_entry(ContextKind::plane, "Put the cube here");
  EXPECT_TRUE(state_.document.other_cube_rays.contains(2));
  const CubeAnchor cube = moved()->other_cubes.at(0);
  EXPECT_NE(cube, inspection_->other_cubes[0]);
  EXPECT_NEAR(cube.origin.z(), 0.5, 1e-9);
  EXPECT_LT(angle_deg(cube.axes.col(2), -Eigen::Vector3d::UnitZ()), 1e-6);
  EXPECT_EQ(moved()->cube, inspection_->cube) << "the floor's cube stays";
  run_line(state_, "undo");
  EXPECT_EQ(moved()->other_cubes, inspection_->other_cubes);
}

TEST_F(SceneWithAWall, MenuOfTheWallInTheScenePutsTheCubeOntoIt) {
  const auto patches = plane_patches(*inspection_);
  ASSERT_EQ(patches.size(), 1U);
  const Eigen::Vector3d to = (patches[0].corners[0] + patches[0].corners[2]) / 2;
  click(on_scene(to), 1);
  run_entry(ContextKind::plane, "Put the cube here");
  EXPECT_TRUE(state_.document.other_cube_rays.contains(2));
  EXPECT_LT((moved()->other_cubes.at(0).origin - to).norm(), 0.02);
}

TEST_F(SceneWithAWall, DraggingTheCubeInTheImageMovesItAlongItsPlaneInOneUndoStep) {
  const Eigen::Vector3d center = inspection_->other_cubes.at(0).origin;
  const ImageMapping mapping = map_image(state_.document.recording->camera, image(), {}, false);
  const Pose& camera = inspection_->initialization->cameras[kFrame - kStart];
  const auto on_image = [&](const Eigen::Vector3d& point) {
    return to_screen(mapping, project(inspection_->recording->camera, to_camera(camera, point)));
  };
  const Vector2d grip = on_image(center);
  point_at(grip);
  press(true);
  for (int step = 1; step <= 4; ++step) point_at(grip + step * Vector2d(-5, 4));
  press(false);
  const CubeAnchor moved_cube = moved()->other_cubes.at(0);
  EXPECT_NEAR(moved_cube.origin.z(), 0.5, 1e-9) << "on the wall";
  EXPECT_LT((on_image(moved_cube.origin) - (grip + Vector2d(-20, 16))).norm(), 1.5);
  EXPECT_EQ(state_.view.image_zoom.center, Vector2d(0.5, 0.5)) << "must not pan";
  EXPECT_EQ(moved()->cube, inspection_->cube);
  run_line(state_, "undo");
  EXPECT_TRUE(state_.document.other_cube_rays.empty());
}

TEST_F(SceneWithAWall, ScriptMovesTheCubeOfThePlaneUnderAPixelAndPicksPointsForTheScale) {
  const auto wall = inspection_->window->planes[1].tracks;
  const auto& tracks = *inspection_->tracks;
  apply(state_, GoToFrame{kStart});
  const auto text = [&](int column) {
    const Vector2d px = tracks.raw_px[0].col(column);
    return fmt::format("{} {}", px.x(), px.y());
  };
  run_line(state_, "move-cube " + text(wall[0]));
  EXPECT_TRUE(state_.document.other_cube_rays.contains(2));
  run_line(state_, "reset-cube");
  EXPECT_TRUE(state_.document.other_cube_rays.empty());
  EXPECT_THAT(test::refusal(state_, "set-scale 0.5"), testing::HasSubstr("pick two points"));
  run_line(state_, "pick " + text(wall[0]));
  run_line(state_, "pick " + text(wall[1]));
  run_line(state_, "set-scale 0.5");
  const Settings set = state_.document.settings;
  EXPECT_EQ(set.scale_length, 0.5);
  EXPECT_EQ(set.scale_points.frame(), kStart);
  Inspection measured = *inspection_;
  measured.settings = set;
  const auto position = [&](int column) {
    return *point_on_plane(
        measured, 0, tracks.raw_px[0].col(column), {-Eigen::Vector3d::UnitZ(), 0.5});
  };
  EXPECT_NEAR(measure_scale(measured)->meters_per_unit,
              0.5 / (position(wall[0]) - position(wall[1])).norm(),
              1e-9);
  EXPECT_THAT(test::refusal(state_, "set-scale 0.5 1 1 1 1"), testing::HasSubstr("two different"));
  EXPECT_THAT(test::refusal(state_, "set-scale -1"), testing::HasSubstr("expected a number"));
  EXPECT_EQ(state_.document.settings, set) << "a refused command changes nothing";
  run_line(state_, "set-origin");
  EXPECT_EQ(state_.document.settings.world_points, set.scale_points);
  run_line(state_, "undo");
  run_line(state_, "undo");
  EXPECT_TRUE(state_.document.settings.scale_points.empty());
}

TEST_F(SceneWithAWall, AltClickPicksTwoPoints) {
  const Vector2d middle = image().min + image().size / 2;
  test::hold(false, false, true);
  click(middle - Vector2d(40, 0));
  click(middle + Vector2d(40, 0));
  test::hold(false, false);
  EXPECT_EQ(state_.selection.points_px.size(), 2U);
  EXPECT_EQ(state_.selection.points_frame, kFrame);
  EXPECT_TRUE(state_.selection.tracks.empty());
}

TEST_F(SceneWithAWall, MenuOfAPlaneWithoutEstimateSaysWhyTheCubeStays) {
  Inspection unknown = *inspection_;
  auto result = std::make_shared<Initialization>(*unknown.initialization);
  result->planes.resize(1);
  unknown.initialization = result;
  open(unknown);
  apply(state_, GoToFrame{kFrame});
  click(track_of_the_wall(), 1);
  EXPECT_TRUE(state_.document.other_cube_rays.empty());
  EXPECT_EQ(line_of_entry(ContextKind::plane, "Put the cube here"), "");
  EXPECT_EQ(subject(ContextKind::plane).why_not_there,
            "The cube cannot move here: plane 2 has no estimate");
  EXPECT_EQ(test::refusal(state_, "put-cube 0 0 1 2"), "put-cube: plane 2 has no estimate");
}

TEST_F(SceneWithAWall, MenuOfATrackOffersWhatCanBeDoneWithIt) {
  const Settings before = state_.document.settings;
  click(track_of_the_wall(), 1);
  EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel));
  EXPECT_EQ(state_.document.settings, before);
  EXPECT_TRUE(state_.selection.tracks.empty());
  const std::int64_t id = subject(ContextKind::track).track;
  EXPECT_THAT(subject(ContextKind::track).title,
              testing::StartsWith(fmt::format("Track {}: ", id)));
  run_entry(ContextKind::track, "Why, and its whole life");
  EXPECT_EQ(state_.selection.focus, id);
  EXPECT_EQ(state_.view.panes.drawer, find_pane("track"));
  EXPECT_THAT(state_.messages.text, testing::StartsWith(fmt::format("track {}: ", id)));
  const TrackLife life = track_life(*inspection_, *column_of(*inspection_->tracks, id));
  run_entry(ContextKind::track, "Go to its last frame");
  EXPECT_EQ(state_.view.frame, life.frames.back().frame);
  run_entry(ContextKind::track, "Go to its first frame");
  EXPECT_EQ(state_.view.frame, life.frames.front().frame);
  run_entry(ContextKind::track, "Copy it as CSV");
  const std::string copied = state_.requests.copied.value_or("");
  EXPECT_EQ(std::ranges::count(copied, '\n'), 1 + std::ssize(life.frames)) << copied;
  run_entry(ContextKind::track, "Make its plane the main one");
  EXPECT_EQ(state_.document.settings.options.plane, 2);
  run_entry(ContextKind::track, "Exclude it");
  EXPECT_THAT(state_.document.settings.exclude, ElementsAre(id));
  EXPECT_EQ(line_of_entry(ContextKind::track, "Exclude it"), "") << "it is excluded already";
}

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
  EXPECT_EQ(titles.size(), 14U);
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

TEST_F(SceneWithAWall, ClickOnATrackOfAnotherPlaneChangesNoSettings) {
  const Settings before = state_.document.settings;
  click(track_of_the_wall());
  ASSERT_TRUE(state_.selection.focus);
  EXPECT_EQ(state_.document.settings, before);
  run_line(state_, "main-plane");
  EXPECT_EQ(state_.document.settings.options.plane, 2);
  run_line(state_, "undo");
  EXPECT_EQ(state_.document.settings, before);
  run_line(state_, "main-plane 2");
  EXPECT_EQ(state_.document.settings.options.plane, 2);
}

TEST_F(SceneWithAWall, KeepsTheColorsOfPlanesWhenAnotherOneLeads) {
  const int column = inspection_->window->planes[1].tracks.front();
  const SignStyle before = track_style(*inspection_, 0, column);
  Inspection other = *inspection_;
  auto window = std::make_shared<Window>(*other.window);
  window->leader = 1;
  window->inlier = window->planes[1].inlier;
  other.window = window;
  const SignStyle after = track_style(other, 0, column);
  EXPECT_EQ(before.rgb, after.rgb);
  EXPECT_EQ(before.sign, Sign::thin_circle);
  EXPECT_EQ(after.sign, Sign::circle);
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

}  // namespace
}  // namespace gpo
