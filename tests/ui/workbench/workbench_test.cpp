// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"

#include <map>

#include <gtest/gtest.h>

namespace gpo {
namespace {

std::shared_ptr<Recording> recording_of(int frames) {
  auto recording = std::make_shared<Recording>();
  for (int i = 0; i < frames; ++i) recording->timestamps_ns.push_back(100'000'000LL * i);
  return recording;
}

WorkbenchState opened(int frames = 60) {
  WorkbenchState state;
  apply_recording(state, recording_of(frames));
  return state;
}

void run(WorkbenchState& state, const std::string& action) { apply(state, RunAction{action}); }

void run_all(WorkbenchState& state, std::initializer_list<const char*> actions) {
  for (const char* action : actions) run(state, action);
}

void expect_legal(const Settings& settings, int frame_count) {
  EXPECT_GE(settings.start, 0);
  EXPECT_GE(settings.frames, 2);
  EXPECT_LE(settings.frames, 1000);
  EXPECT_LE(settings.start + settings.frames, frame_count);
}

TEST(Workbench, FitsTheWindowIntoAShortRecording) {
  WorkbenchState state;
  state.document.settings.start = 500;
  apply_recording(state, recording_of(12));
  expect_legal(state.document.settings, 12);
  EXPECT_EQ(state.view.frame, 11);
  EXPECT_EQ(state.messages.text,
            "Start frame 500 is outside of the recording: the last of 12 frames is 11");
}

TEST(Workbench, EachRecordingHasItsOwnWindowAndMethod) {
  const auto desk = recording_of(300), room = recording_of(400);
  desk->path = "desk";
  room->path = "room";
  WorkbenchState state;
  state.document.settings.start = 5;  // from the command line
  apply_recording(state, desk);
  EXPECT_EQ(state.document.settings.start, 5);
  const Settings chosen{.start = 180, .frames = 47, .options = {.method = "ba"}};
  apply(state, ChangeSettings{chosen});
  apply_recording(state, room);
  const Settings usual{.start = 0, .frames = 30, .options = {.method = "gpo_joint"}};
  EXPECT_EQ(state.document.settings, usual);
  EXPECT_EQ(state.view.frame, 29);
  apply_recording(state, desk);
  EXPECT_EQ(state.document.settings, chosen);
  run(state, "reset");
  EXPECT_EQ(state.document.settings, Settings{});
  run(state, "undo");
  EXPECT_EQ(state.document.settings, chosen);
}

TEST(Workbench, StepsAndScrubbingStayInsideTheRecording) {
  WorkbenchState state = opened(25);
  for (const auto& [action, frame] : {std::pair{"last", 24},
                                      {"next", 24},
                                      {"next-ten", 24},
                                      {"previous", 23},
                                      {"previous-ten", 13},
                                      {"next-ten", 23},
                                      {"next", 24},
                                      {"first", 0},
                                      {"previous", 0},
                                      {"previous-ten", 0}}) {
    run(state, action);
    EXPECT_EQ(state.view.frame, frame) << action;
  }
  apply(state, GoToFrame{1000});
  EXPECT_EQ(state.view.frame, 24);
  apply(state, GoToFrame{-5});
  EXPECT_EQ(state.view.frame, 0);
}

TEST(Workbench, PlaysAtTheRateOfTheRecordingAndStopsAtItsEnd) {
  WorkbenchState state = opened(25);
  run_all(state, {"first", "play"});
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

TEST(Workbench, PlayRestartsAtTheEndAndPausesOnASecondPressOrStep) {
  WorkbenchState state = opened(25);
  run_all(state, {"last", "play"});
  EXPECT_EQ(state.view.frame, 0);
  run(state, "play");
  EXPECT_FALSE(state.view.playing);
  advance(state, 10);
  EXPECT_EQ(state.view.frame, 0);
  run_all(state, {"play", "next"});
  EXPECT_FALSE(state.view.playing);
}

TEST(Workbench, TogglesChangeOnlyTheirView) {
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

TEST(Workbench, UncertaintyIsEnlargedInStepsAndSwitchedOff) {
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

TEST(Workbench, DigitKeysChooseMethodsInTableOrder) {
  WorkbenchState state = opened();
  for (std::size_t i = 0; i < methods().size() && i < 9; ++i) {
    const Action* action = action_of_character(U'1' + i);
    ASSERT_NE(action, nullptr);
    run(state, action->name);
    EXPECT_EQ(state.document.settings.options.method, methods()[i].key);
    EXPECT_TRUE(action->checked(state));
  }
}

TEST(Workbench, WindowKeepsTheOtherEndOrElseItsLength) {
  struct Step {
    int frame, start, frames;
  };
  for (const auto& [action, before, first, second] :
       {std::tuple{"window-start", 0, Step{10, 10, 20}, Step{35, 35, 20}},
        {"window-end", 20, {25, 20, 6}, {10, 5, 6}}}) {
    WorkbenchState state = opened(60);
    state.document.settings.start = before;
    for (const Step& step : {first, second}) {
      apply(state, GoToFrame{step.frame});
      run(state, action);
      EXPECT_EQ(state.document.settings.start, step.start) << action;
      EXPECT_EQ(state.document.settings.frames, step.frames) << action;
    }
  }
}

TEST(Workbench, WindowIsAlwaysValid) {
  for (const int count : {2, 3, 31, 1500})
    for (int frame = 0; frame<count; frame += count> 100 ? 37 : 1) {
      for (const Settings& before : {Settings{},
                                     Settings{.start = count - 2, .frames = 2},
                                     Settings{.start = 0, .frames = count}}) {
        const auto after = [&](const char* action) {
          WorkbenchState state = opened(count);
          state.document.settings = fit_window(before, count);
          state.view.frame = frame;
          run(state, action);
          expect_legal(state.document.settings, count);
          return state.document.settings;
        };
        EXPECT_EQ(after("window-start").start, std::min(frame, count - 2));
        const Settings ending = after("window-end");
        EXPECT_EQ(ending.start + ending.frames - 1, std::max(frame, 1));
      }
    }
}

TEST(Workbench, SettingsAndCubeSideAreClamped) {
  WorkbenchState state = opened(20);
  apply(state, ChangeSettings{{.start = 18, .frames = 50}});
  expect_legal(state.document.settings, 20);
  apply(state, ChangeSettings{{.start = -3, .frames = -1}});
  expect_legal(state.document.settings, 20);
  for (const auto& [requested, side] : {std::pair{0.3, 0.3}, {-1.0, 0.0}, {9.0, 2.0}}) {
    apply(state, SetCubeSide{requested});
    EXPECT_DOUBLE_EQ(state.document.cube_side, side);
  }
}

TEST(Workbench, FitResetsImageAndScene) {
  WorkbenchState state = opened();
  apply(state, ZoomImage{{.factor = 4}});
  gpo::apply(state, OrbitScene{OrbitCamera{.yaw_deg = 50}});
  EXPECT_EQ(state.view.image_zoom.factor, 4);
  ASSERT_TRUE(state.view.orbit.has_value());
  gpo::apply(state, OrbitScene{});
  EXPECT_FALSE(state.view.orbit.has_value());
  EXPECT_EQ(state.view.image_zoom.factor, 4);
  gpo::apply(state, OrbitScene{OrbitCamera{.yaw_deg = 50}});
  run(state, "fit");
  EXPECT_EQ(state.view.image_zoom.factor, 1);
  EXPECT_FALSE(state.view.orbit.has_value());
}

TEST(Workbench, NormalsAreZoomedByTilt) {
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

TEST(Workbench, EscapeClosesHelpBeforeItCancels) {
  WorkbenchState state = opened();
  run(state, "help");
  EXPECT_TRUE(state.view.show_help);
  for (const bool cancels : {false, true}) {
    run(state, "escape");
    EXPECT_FALSE(state.view.show_help);
    EXPECT_EQ(state.requests.cancel, cancels);
  }
}

TEST(Workbench, ActionsLeaveRequestsForTheWindow) {
  WorkbenchState state = opened();
  run(state, "save-picture");
  ASSERT_EQ(state.requests.screenshots.size(), 1U);
  EXPECT_EQ(state.requests.screenshots.front().view, "picture");
  run_all(state, {"quit", "open-example", "compute"});
  EXPECT_TRUE(state.requests.quit);
  EXPECT_TRUE(state.requests.open_example);
  EXPECT_TRUE(state.requests.compute);
  apply(state, OpenPath{"desk"});
  EXPECT_EQ(state.requests.open, "desk");
}

TEST(Workbench, WithoutARecordingActionsOnlySaySo) {
  setenv("XDG_STATE_HOME", GPO_TEST_OUTPUT_DIR "/nothing-was-open", 1);
  for (const Action& action : actions()) {
    if (!action.complete()) continue;
    WorkbenchState state;
    run(state, action.name);
    EXPECT_EQ(state.view.frame, 0) << action.name;
    EXPECT_FALSE(state.view.playing) << action.name;
    const std::map<std::string, std::string> messages = {
        {"continue", "no previous session"},
        {"freeze", "freeze: no camera or stream is open"},
        {"live", "live: only a user at the window opens cameras and streams, no script"}};
    const auto own = messages.find(action.name);
    const std::string message = action.needs_recording  ? "no recording is open"
                                : own != messages.end() ? own->second
                                                        : "";
    EXPECT_EQ(state.messages.text, message) << action.name;
    if (action.value) action.value(state);
  }
}

TEST(Workbench, UndoRestoresSettingsAndWholeDrags) {
  WorkbenchState state = opened(60);
  const Settings first = state.document.settings;
  run(state, "ransac");
  const Settings second = state.document.settings;
  for (const double px : {2.1, 2.2, 2.3}) {
    Settings settings = state.document.settings;
    settings.options.ransac_threshold_px = px;
    apply(state, ChangeSettings{settings, true});
  }
  for (const Settings& expected : {second, first, first}) {
    run(state, "undo");
    EXPECT_EQ(state.document.settings, expected);
  }
  run_all(state, {"redo", "redo"});
  EXPECT_EQ(state.document.settings.options.ransac_threshold_px, 2.3);
}

TEST(Workbench, UndoRestoresTheCubeSideAlone) {
  WorkbenchState state = opened(60);
  run(state, "ransac");
  const Settings changed = state.document.settings;
  for (const double side : {0.2, 0.3, 0.4}) apply(state, SetCubeSide{side, 1});
  run(state, "undo");
  EXPECT_EQ(state.document.cube_side, 0) << "the drag is one step";
  EXPECT_EQ(state.document.settings, changed);
  run(state, "redo");
  EXPECT_EQ(state.document.cube_side, 0.4);
}

TEST(Workbench, UndoRestoresOneOfTwoDrags) {
  WorkbenchState state = opened(60);
  for (const double drag : {1.5, 3.0})
    for (const double px : {drag + 0.1, drag + 0.2}) {
      Settings settings = state.document.settings;
      settings.options.ransac_threshold_px = px;
      apply(state, ChangeSettings{settings, drag});
    }
  run(state, "undo");
  EXPECT_EQ(state.document.settings.options.ransac_threshold_px, 1.7);
}

TEST(Workbench, UndoRestoresTheCubePosition) {
  WorkbenchState state = opened(60);
  const Eigen::Vector3d there(0.1, 0.2, 1), elsewhere(0.3, 0.2, 1);
  for (const Eigen::Vector3d& ray : {there, elsewhere}) move_cube(state, ray);
  for (const auto& [action, ray] : {std::pair{"undo", std::optional(there)},
                                    {"redo", elsewhere},
                                    {"reset-cube", std::nullopt},
                                    {"undo", elsewhere}}) {
    run(state, action);
    EXPECT_EQ(state.document.cube_ray, ray) << action;
  }
}

TEST(Workbench, RansacSwitchedTwiceIsTheDefaultAgain) {
  WorkbenchState state = opened(60);
  const Settings& settings = state.document.settings;
  const Settings first = settings;
  run(state, "ransac");
  EXPECT_EQ(settings.options.ransac, false);
  EXPECT_FALSE(uses_ransac(settings.options));
  run(state, "ransac");
  EXPECT_TRUE(uses_ransac(settings.options));
  EXPECT_EQ(settings, first);
}

TEST(Workbench, AnErrorIsRetractedOnlyIfItIsShown) {
  WorkbenchState state = opened(60);
  say(state, "saved");
  say(state, "cannot be read", Severity::error);
  retract_error(state, "another one");
  EXPECT_EQ(state.messages.text, "cannot be read");
  retract_error(state, "cannot be read");
  EXPECT_EQ(state.messages.text, "");
  EXPECT_EQ(state.messages.lines.size(), 2U) << "the log keeps it";
}

TEST(Workbench, NotesVanishAndErrorsStay) {
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
