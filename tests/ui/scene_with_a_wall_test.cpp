// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/linked_selection.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::Contains, testing::ElementsAre;

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
  for (WindowPlane& plane : window->planes) plane.H_i1 = window->H_i1;
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
  run_line(state_, "put-cube " + text(wall[0]));
  EXPECT_TRUE(state_.document.other_cube_rays.contains(2));
  run_line(state_, "reset-cube");
  EXPECT_TRUE(state_.document.other_cube_rays.empty());
  EXPECT_THAT(refusal(state_, "set-scale 0.5"), testing::HasSubstr("pick two points"));
  run_line(state_, "pick " + text(wall[0]));
  run_line(state_, "pick " + text(wall[1]));
  run_line(state_, "set-scale 0.5");
  EXPECT_THAT(state_.messages.text, testing::HasSubstr("in meters by these points"));
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
  EXPECT_THAT(refusal(state_, "set-scale 0.5 1 1 1 1"), testing::HasSubstr("two different"));
  EXPECT_THAT(refusal(state_, "set-scale -1"), testing::HasSubstr("expected a number"));
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
  EXPECT_EQ(refusal(state_, "put-cube 0 0 1 2"), "put-cube: plane 2 has no estimate");
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

}  // namespace
}  // namespace gpo::test
