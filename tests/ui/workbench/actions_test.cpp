// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/actions.h"

#include "ui/workbench/work/apply_recording.h"

#include <set>

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

WorkbenchState with_frames(int frames) {
  auto recording = std::make_shared<Recording>();
  for (int i = 0; i < frames; ++i) recording->timestamps_ns.push_back(100'000'000LL * i);
  WorkbenchState state;
  apply_recording(state, recording);
  return state;
}

TEST(Actions, HaveUniqueNamesAndKeysAndAreExplained) {
  std::set<std::string> names;
  std::set<std::string> labels;
  for (const Action& action : actions()) {
    EXPECT_TRUE(names.insert(action.name).second) << action.name;
    EXPECT_FALSE(action.title.empty()) << action.name;
    EXPECT_FALSE(action.tooltip.empty()) << action.name;
    ASSERT_TRUE(action.run) << action.name;
    for (const Shortcut& shortcut : action.shortcuts) {
      EXPECT_TRUE(labels.insert(shortcut.label).second) << shortcut.label;
    }
  }
}

TEST(Actions, TakeArgumentsAndSayWhatIsWrongWithThem) {
  WorkbenchState state = with_frames(60);
  run_line(state, "frame 40");
  EXPECT_EQ(state.view.frame, 40);
  run_line(state, "method pba");
  EXPECT_EQ(state.document.settings.options.method, "pba");
  run_line(state, "set ransac_threshold_px 3.5");
  EXPECT_EQ(state.document.settings.options.ransac_threshold_px, 3.5);
  run_line(state, "ransac_threshold_px 2.5");  // a setting's name is enough
  EXPECT_EQ(state.document.settings.options.ransac_threshold_px, 2.5);
  run_line(state, "exaggerate");
  EXPECT_EQ(state.view.toggles.exaggeration, 5);
  run_line(state, "exaggerate 100");
  run_line(state, "exaggerate");
  EXPECT_EQ(state.view.toggles.exaggeration, 1);
  run_line(state, "point-size 9");
  EXPECT_EQ(state.view.toggles.point_size_px, 9);
  run_line(state, "color-by residual");
  EXPECT_EQ(state.view.coloring, Coloring::residual);
  run_line(state, "viewpoint top");
  EXPECT_EQ(state.view.viewpoint, Viewpoint::top);
  run_line(state, "tails off");
  EXPECT_FALSE(state.view.toggles.tails);
  for (const auto& [line, what] :
       {std::pair{"frame", "frame: expected one word after it"},
        {"frame x", "frame: 'x', expected a number"},
        {"frame 1 2", "frame: '2' is one word too many"},
        {"point-size 30", "point-size: '30', expected 1 to 20"},
        {"method nobody", "method: unknown value 'nobody', expected one of gpo"},
        {"start x", "start: 'x', expected"},
        {"nobody 3", "no action is called \"nobody\"; F1 lists them"},
        {"set seed -1", "seed: '-1', expected a number from 0 to 1e+09"},
        {"set colour red", "unknown setting 'colour'"},
        {"tails perhaps", "tails: 'perhaps', expected on or off"},
        {"screenshot a.jpg", "screenshot: 'a.jpg', expected a file name that ends in .png"},
        {"select track 7", "select track: the window has no track 7"}}) {
    run_action(state, line);
    EXPECT_THAT(state.messages.text, testing::HasSubstr(what)) << line;
  }
}

TEST(Actions, AreFoundByTheKeysThatTheDesignNames) {
  EXPECT_EQ(action_of_key(GLFW_KEY_LEFT, false)->name, "previous");
  EXPECT_EQ(action_of_key(GLFW_KEY_RIGHT, false)->name, "next");
  EXPECT_EQ(action_of_key(GLFW_KEY_LEFT, true)->name, "previous-ten");
  EXPECT_EQ(action_of_key(GLFW_KEY_RIGHT, true)->name, "next-ten");
  EXPECT_EQ(action_of_key(GLFW_KEY_HOME, false)->name, "first");
  EXPECT_EQ(action_of_key(GLFW_KEY_END, false)->name, "last");
  EXPECT_EQ(action_of_key(GLFW_KEY_F1, false)->name, "help");
  EXPECT_EQ(action_of_key(GLFW_KEY_ESCAPE, false)->name, "escape");
  EXPECT_EQ(action_of_key(GLFW_KEY_Q, false, true)->name, "quit");
  EXPECT_EQ(action_of_key(GLFW_KEY_Q, false), nullptr);
  EXPECT_EQ(action_of_key(GLFW_KEY_UNKNOWN, false), nullptr);
  for (const auto& [character, name] : {std::pair{U' ', "play"},
                                        {U'[', "window-start"},
                                        {U']', "window-end"},
                                        {U't', "tails"},
                                        {U'T', "tails"},
                                        {U'e', "residuals"},
                                        {U'b', "cube"},
                                        {U'g', "truth"},
                                        {U'r', "ransac"},
                                        {U'f', "fit"},
                                        {U's', "save-picture"},
                                        {U'?', "help"},
                                        {U'1', "method gpo"}}) {
    ASSERT_NE(action_of_character(character), nullptr) << name;
    EXPECT_EQ(action_of_character(character)->name, name);
  }
  EXPECT_EQ(action_of_character(U'\u00e4'), nullptr);
}

}  // namespace
}  // namespace gpo
