// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/initializers/methods.h"
#include "engine/inspection/settings/setting_values.h"
#include "ui/workbench/actions/tables.h"
#include "ui/workbench/undo.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void add_methods(std::vector<Action>& table) {
  for (std::size_t i = 0; i < methods().size(); ++i) {
    const Method& method = methods()[i];
    std::vector<Shortcut> shortcuts;
    if (i < 9) shortcuts.push_back(letter(static_cast<char>('1' + i)));
    Action action = plain("method " + method.key,
                          method.title,
                          "Method",
                          shortcuts,
                          "Initializes with " + method.title,
                          [key = method.key](State& s) {
                            Settings settings = s.settings;
                            settings.method = key;
                            change_settings(s, settings);
                          });
    action.checked = [key = method.key](const State& s) { return s.settings.method == key; };
    action.needs_recording = false;
    table.push_back(action);
  }
}

void add_settings(std::vector<Action>& table) {
  Action ransac = plain("ransac",
                        "RANSAC",
                        "Method",
                        {letter('R')},
                        "Rejects outliers by a homography from the reference frame",
                        [](State& s) {
                          Settings settings = s.settings;
                          settings.ransac = !uses_ransac(settings);
                          change_settings(s, settings);
                        });
  ransac.checked = [](const State& s) { return uses_ransac(s.settings); };
  ransac.needs_recording = false;
  table.push_back(ransac);
  Action set{"set", "Change a setting", "Method", {}, "Gives a setting another value"};
  set.arguments = "SETTING VALUE";
  set.needs_recording = false;
  set.run = [](State& s, const Arguments& arguments) {
    expect_count("set", arguments, 2, 2);
    change_settings(s, with_setting(s.settings, arguments[0], arguments[1]));
  };
  table.push_back(set);
  Action preset{"preset",
                "Choose a preset",
                "Method",
                {},
                "All settings but the window: the best that we have, or what the paper does"};
  preset.arguments = "best|paper";
  preset.needs_recording = false;
  preset.run = [](State& s, const Arguments& arguments) {
    expect_count("preset", arguments, 1, 1);
    change_settings(s, with_preset(s.settings, choice<Preset>(arguments[0])));
  };
  table.push_back(preset);
  Action reset{"reset",
               "Reset settings",
               "Method",
               {},
               "Gives a setting, or all but the window and the method, its default value"};
  reset.arguments = "[SETTING]";
  reset.needs_recording = false;
  reset.run = [](State& s, const Arguments& arguments) {
    expect_count("reset", arguments, 0, 1);
    change_settings(
        s, arguments.empty() ? with_defaults(s.settings) : with_default(s.settings, arguments[0]));
  };
  table.push_back(reset);
}

}  // namespace

void add_method_actions(std::vector<Action>& table) {
  add_methods(table);
  add_settings(table);
  table.push_back(plain("compute",
                        "Compute again",
                        "Method",
                        {key(GLFW_KEY_F5, "F5")},
                        "Computes with the same settings, say after Esc",
                        [](State& s) { s.wishes.compute = true; }));
}

}  // namespace gpo
