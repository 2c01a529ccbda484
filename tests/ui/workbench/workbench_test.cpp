// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/apply.h"
#include "ui/workbench/playing.h"
#include "ui/workbench/state.h"
#include "ui/workbench/time_span.h"
#include "ui/workbench/work/apply_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

std::shared_ptr<const Recording> recording_of(int frames, double rate_hz = 10) {
  auto recording = std::make_shared<Recording>();
  for (int i = 0; i < frames; ++i) {
    recording->timestamps_ns.push_back(static_cast<std::int64_t>(i * 1e9 / rate_hz));
  }
  return recording;
}

WorkbenchState opened(int frames = 60) {
  WorkbenchState state;
  apply_recording(state, recording_of(frames));
  return state;
}

void run(WorkbenchState& state, const std::string& action) { apply(state, RunAction{action}); }

void expect_legal(const Settings& settings, int frame_count) {
  EXPECT_GE(settings.start, 0);
  EXPECT_GE(settings.frames, 2);
  EXPECT_LE(settings.frames, 1000);
  EXPECT_LE(settings.start + settings.frames, frame_count);
}

TEST(Workbench, ShowsTheLastFrameOfTheWindowOfANewRecording) {
  const WorkbenchState state = opened(60);
  EXPECT_EQ(state.document.settings.start, 0);
  EXPECT_EQ(state.document.settings.frames, 30);
  EXPECT_EQ(state.view.frame, 29);
}

TEST(Workbench, FitsTheWindowIntoAShortRecordingAndSaysSo) {
  WorkbenchState state;
  state.document.settings.start = 500;
  apply_recording(state, recording_of(12));
  expect_legal(state.document.settings, 12);
  EXPECT_EQ(state.view.frame, 11);
  EXPECT_EQ(state.messages.text, "start 500 does not fit: the last of 12 frames is 11");
}

TEST(Workbench, EachRecordingHasItsOwnWindowAndMethod) {
  const auto desk = std::make_shared<Recording>(*recording_of(300));
  const auto room = std::make_shared<Recording>(*recording_of(400));
  desk->path = "desk";
  room->path = "room";
  WorkbenchState state;
  state.document.settings.start = 5;  // the command line's
  apply_recording(state, desk);
  EXPECT_EQ(state.document.settings.start, 5);
  Settings chosen = state.document.settings;
  chosen.start = 180;
  chosen.frames = 47;
  chosen.options.method = "ba";
  apply(state, ChangeSettings{chosen});
  apply_recording(state, room);
  EXPECT_EQ(state.document.settings.start, 0);
  EXPECT_EQ(state.document.settings.frames, 30);
  EXPECT_EQ(state.document.settings.options.method, "gpo_joint");
  EXPECT_EQ(state.view.frame, 29);
  apply_recording(state, desk);
  EXPECT_EQ(state.document.settings, chosen);
  run(state, "reset");
  EXPECT_EQ(state.document.settings, Settings{});
  run(state, "undo");
  EXPECT_EQ(state.document.settings, chosen);
}

TEST(Workbench, StepsStayInsideTheRecording) {
  WorkbenchState state = opened(25);
  run(state, "last");
  EXPECT_EQ(state.view.frame, 24);
  run(state, "next");
  run(state, "next-ten");
  EXPECT_EQ(state.view.frame, 24);
  run(state, "previous");
  EXPECT_EQ(state.view.frame, 23);
  run(state, "previous-ten");
  EXPECT_EQ(state.view.frame, 13);
  run(state, "next-ten");
  EXPECT_EQ(state.view.frame, 23);
  run(state, "next");
  EXPECT_EQ(state.view.frame, 24);
  run(state, "first");
  EXPECT_EQ(state.view.frame, 0);
  run(state, "previous");
  run(state, "previous-ten");
  EXPECT_EQ(state.view.frame, 0);
}

TEST(Workbench, ScrubbingStaysInsideTheRecording) {
  WorkbenchState state = opened(25);
  apply(state, GoToFrame{-5});
  EXPECT_EQ(state.view.frame, 0);
  apply(state, GoToFrame{1000});
  EXPECT_EQ(state.view.frame, 24);
}

TEST(Workbench, PlaysAtTheRateOfTheRecordingAndStopsAtItsEnd) {
  WorkbenchState state = opened(25);
  run(state, "first");
  run(state, "play");
  EXPECT_TRUE(state.view.playing);
  EXPECT_DOUBLE_EQ(*seconds_to_next_frame(state), 0.1);
  advance(state, 0.04);
  EXPECT_EQ(state.view.frame, 0);
  EXPECT_NEAR(*seconds_to_next_frame(state), 0.06, 1e-12);
  advance(state, 0.27);  // 0.31 s in all
  EXPECT_EQ(state.view.frame, 3);
  advance(state, 100);
  EXPECT_EQ(state.view.frame, 24);
  EXPECT_FALSE(state.view.playing);
  EXPECT_FALSE(seconds_to_next_frame(state).has_value());
}

TEST(Workbench, PlayAtTheEndBeginsAgainAndASecondPressPauses) {
  WorkbenchState state = opened(25);
  run(state, "last");
  run(state, "play");
  EXPECT_EQ(state.view.frame, 0);
  run(state, "play");
  EXPECT_FALSE(state.view.playing);
  advance(state, 10);
  EXPECT_EQ(state.view.frame, 0);
}

TEST(Workbench, StepPausesPlaying) {
  WorkbenchState state = opened();
  run(state, "play");
  run(state, "next");
  EXPECT_FALSE(state.view.playing);
}

TEST(Workbench, TogglesSwitchTheirViewAndNothingElse) {
  for (const auto& [name, flag] : {std::pair{"tracks", &ViewToggles::tracks},
                                   {"tails", &ViewToggles::tails},
                                   {"residuals", &ViewToggles::residuals},
                                   {"cube", &ViewToggles::cube},
                                   {"truth", &ViewToggles::truth}}) {
    WorkbenchState state = opened();
    const bool before = state.view.toggles.*flag;
    run(state, name);
    EXPECT_NE(state.view.toggles.*flag, before) << name;
    EXPECT_EQ(find_action(name)->checked(state), !before) << name;
    run(state, name);
    EXPECT_EQ(state.view.toggles.*flag, before) << name;
    EXPECT_EQ(state.document.settings, opened().document.settings) << name;
  }
}

TEST(Workbench, UncertaintyIsEnlargedStepByStepAndSwitchedOff) {
  WorkbenchState state;
  const Action& action = *find_action("uncertainty");
  EXPECT_EQ(action_of_character(U'u'), &action);
  for (const auto& [times, text] :
       {std::pair{1, "on"}, {10, "\u00d710"}, {100, "\u00d7100"}, {0, "off"}, {1, "on"}}) {
    EXPECT_EQ(state.view.toggles.uncertainty, times);
    EXPECT_EQ(action.value(state), text);
    EXPECT_EQ(action.checked(state), times > 0);
    run_action(state, "uncertainty");
  }
}

TEST(Workbench, RansacIsSwitched) {
  WorkbenchState state = opened();
  run(state, "ransac");
  EXPECT_FALSE(uses_ransac(state.document.settings.options));
  run(state, "ransac");
  EXPECT_TRUE(uses_ransac(state.document.settings.options));
}

TEST(Workbench, NumbersChooseTheMethodsInTheOrderOfTheTable) {
  WorkbenchState state = opened();
  for (std::size_t i = 0; i < methods().size() && i < 9; ++i) {
    const Action* action = action_of_character(U'1' + i);
    ASSERT_NE(action, nullptr);
    run(state, action->name);
    EXPECT_EQ(state.document.settings.options.method, methods()[i].key);
    EXPECT_TRUE(action->checked(state));
  }
}

TEST(Workbench, WindowStartsHereAndKeepsItsEnd) {
  WorkbenchState state = opened(60);
  apply(state, GoToFrame{10});
  run(state, "window-start");
  EXPECT_EQ(state.document.settings.start, 10);
  EXPECT_EQ(state.document.settings.frames, 20);  // 10..29
  apply(state, GoToFrame{35});
  run(state, "window-start");  // behind its end: keeps its length
  EXPECT_EQ(state.document.settings.start, 35);
  EXPECT_EQ(state.document.settings.frames, 20);
}

TEST(Workbench, WindowEndsHereAndKeepsItsStart) {
  WorkbenchState state = opened(60);
  state.document.settings.start = 20;
  apply(state, GoToFrame{25});
  run(state, "window-end");
  EXPECT_EQ(state.document.settings.start, 20);
  EXPECT_EQ(state.document.settings.frames, 6);  // 20..25
  apply(state, GoToFrame{10});
  run(state, "window-end");  // before its start: keeps its length
  EXPECT_EQ(state.document.settings.start, 5);
  EXPECT_EQ(state.document.settings.frames, 6);
}

TEST(Workbench, WindowIsLegalWhereverItStartsAndEnds) {
  for (const int count : {2, 3, 31, 1500}) {
    for (int frame = 0; frame<count; frame += count> 100 ? 37 : 1) {
      for (const Settings& before : {Settings{},
                                     Settings{.start = count - 2, .frames = 2},
                                     Settings{.start = 0, .frames = count}}) {
        WorkbenchState state = opened(count);
        state.document.settings = fit_window(before, count);
        state.view.frame = frame;
        WorkbenchState other = state;
        run(state, "window-start");
        expect_legal(state.document.settings, count);
        EXPECT_EQ(state.document.settings.start, std::min(frame, count - 2));
        run(other, "window-end");
        expect_legal(other.document.settings, count);
        EXPECT_EQ(other.document.settings.start + other.document.settings.frames - 1,
                  std::max(frame, 1));
      }
    }
  }
}

TEST(Workbench, SettingsOfThePanelAreMadeToFit) {
  WorkbenchState state = opened(20);
  apply(state, ChangeSettings{{.start = 18, .frames = 50}});
  expect_legal(state.document.settings, 20);
  apply(state, ChangeSettings{{.start = -3, .frames = -1}});
  expect_legal(state.document.settings, 20);
}

TEST(Workbench, CubeSideStaysBetweenAutomaticAndTwoDistances) {
  WorkbenchState state;
  apply(state, SetCubeSide{0.3});
  EXPECT_DOUBLE_EQ(state.document.cube_side, 0.3);
  apply(state, SetCubeSide{-1});
  EXPECT_DOUBLE_EQ(state.document.cube_side, 0);
  apply(state, SetCubeSide{9});
  EXPECT_DOUBLE_EQ(state.document.cube_side, 2);
}

TEST(Workbench, FitShowsAllOfImageAndScene) {
  WorkbenchState state = opened();
  apply(state, ZoomImage{{.factor = 4}});
  apply(state, OrbitScene{{.yaw_deg = 50}});
  EXPECT_EQ(state.view.image_zoom.factor, 4);
  ASSERT_TRUE(state.view.orbit.has_value());
  apply(state, FitScene{});
  EXPECT_FALSE(state.view.orbit.has_value());
  EXPECT_EQ(state.view.image_zoom.factor, 4);
  apply(state, OrbitScene{{.yaw_deg = 50}});
  run(state, "fit");
  EXPECT_EQ(state.view.image_zoom.factor, 1);
  EXPECT_FALSE(state.view.orbit.has_value());
}

TEST(Workbench, NormalsAreZoomedByTheirTiltAndFitted) {
  WorkbenchState state = opened();
  run(state, "zoom-normals 10 9 -45");
  EXPECT_EQ(state.view.normals_zoom.factor, 10);
  EXPECT_EQ(state.view.normals_zoom.center, Eigen::Vector2d(0.1, -0.5));
  run(state, "zoom-normals 1e9 900 0");
  EXPECT_EQ(state.view.normals_zoom.factor, kLargestNormalsZoom);
  EXPECT_EQ(state.view.normals_zoom.center, Eigen::Vector2d(1, 0));
  run(state, "fit");
  EXPECT_EQ(state.view.normals_zoom.factor, 1);
}

TEST(Workbench, HelpOpensAndEscapeClosesItBeforeItCancels) {
  WorkbenchState state = opened();
  run(state, "help");
  EXPECT_TRUE(state.view.show_help);
  run(state, "escape");
  EXPECT_FALSE(state.view.show_help);
  EXPECT_FALSE(state.requests.cancel);
  run(state, "escape");
  EXPECT_TRUE(state.requests.cancel);
}

TEST(Workbench, LeavesRequestsForTheWindow) {
  WorkbenchState state = opened();
  run(state, "save-picture");
  ASSERT_EQ(state.requests.screenshots.size(), 1U);
  EXPECT_EQ(state.requests.screenshots.front().view, "picture");
  run(state, "quit");
  EXPECT_TRUE(state.requests.quit);
  run(state, "open-example");
  EXPECT_TRUE(state.requests.open_example);
  run(state, "compute");
  EXPECT_TRUE(state.requests.compute);
  apply(state, OpenPath{"desk"});
  EXPECT_EQ(state.requests.open, "desk");
}

TEST(Workbench, WithoutARecordingActionsSaySoAndDoNoHarm) {
  setenv("XDG_STATE_HOME", GPO_TEST_OUTPUT_DIR "/nothing-was-open", 1);
  for (const Action& action : actions()) {
    if (!action.complete()) continue;
    WorkbenchState state;
    run(state, action.name);
    EXPECT_EQ(state.view.frame, 0) << action.name;
    EXPECT_FALSE(state.view.playing) << action.name;
    const std::string said = action.needs_recording      ? "no recording is open"
                             : action.name == "continue" ? "no session was closed yet"
                                                         : "";
    EXPECT_EQ(state.messages.text, said) << action.name;
    if (action.value) action.value(state);
  }
}

TEST(Workbench, UnknownActionIsNamed) {
  WorkbenchState state;
  run(state, "fly");
  EXPECT_EQ(state.messages.text, "no action is called \"fly\"; F1 lists them");
}

TEST(Workbench, UndoTakesBackSettingsAndDragsAtOnce) {
  WorkbenchState state = opened(60);
  const Settings first = state.document.settings;
  run(state, "ransac");
  const Settings second = state.document.settings;
  for (const double px : {2.1, 2.2, 2.3}) {
    Settings settings = state.document.settings;
    settings.options.ransac_threshold_px = px;
    apply(state, ChangeSettings{settings, true});
  }
  run(state, "undo");
  EXPECT_EQ(state.document.settings, second);
  run(state, "undo");
  EXPECT_EQ(state.document.settings, first);
  run(state, "undo");
  EXPECT_EQ(state.document.settings, first);
  run(state, "redo");
  run(state, "redo");
  EXPECT_EQ(state.document.settings.options.ransac_threshold_px, 2.3);
}

TEST(Workbench, UndoTakesBackTheCubesPlace) {
  WorkbenchState state = opened(60);
  const Eigen::Vector3d there(0.1, 0.2, 1), elsewhere(0.3, 0.2, 1);
  apply(state, MoveCube{there});
  apply(state, MoveCube{elsewhere});
  run(state, "undo");
  EXPECT_EQ(state.document.cube_ray, there);
  run(state, "redo");
  EXPECT_EQ(state.document.cube_ray, elsewhere);
  run(state, "reset-cube");
  EXPECT_EQ(state.document.cube_ray, std::nullopt);
  run(state, "undo");
  EXPECT_EQ(state.document.cube_ray, elsewhere);
}

TEST(Workbench, RansacSwitchedTwiceIsLeftToTheMethodAgain) {
  WorkbenchState state = opened(60);
  const Settings first = state.document.settings;
  run(state, "ransac");
  EXPECT_EQ(state.document.settings.options.ransac, false);
  run(state, "ransac");
  EXPECT_EQ(state.document.settings, first);
}

TEST(Workbench, NotesPassAndErrorsStay) {
  WorkbenchState state = opened(60);
  say(state, "saved");
  advance(state, 5);
  EXPECT_EQ(state.messages.text, "saved");
  advance(state, 60);
  EXPECT_EQ(state.messages.text, "");
  say(state, "cannot be read", Severity::error);
  advance(state, 600);
  EXPECT_EQ(state.messages.text, "cannot be read");
}

}  // namespace
}  // namespace gpo
