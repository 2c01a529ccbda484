// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/initializers/methods.h"
#include "engine/inspection/settings/setting_values.h"
#include "ui/workbench/actions/tables.h"
#include "ui/workbench/undo.h"

#include <array>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void add_choices_of_method(std::vector<Action>& table) {
  for (std::size_t i = 0; i < methods().size(); ++i) {
    const Method& method = methods()[i];
    std::vector<Shortcut> shortcuts;
    if (i < 9) shortcuts.push_back(letter(static_cast<char>('1' + i)));
    Action action = plain("method " + method.key,
                          method.title,
                          "Method",
                          shortcuts,
                          method.help,
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

/// Those that take a setting's name or a preset's.
std::vector<Action> settings_by_name() {
  struct Row {
    const char* name;
    const char* title;
    const char* arguments;
    std::size_t least;
    std::size_t most;
    const char* tooltip;
    Settings (*changed)(const Settings&, const Arguments&);
  };
  const std::array rows = {
      Row{"set",
          "Change a setting",
          "SETTING VALUE",
          2,
          2,
          "Gives a setting another value",
          [](const Settings& s, const Arguments& a) { return with_setting(s, a[0], a[1]); }},
      Row{"preset",
          "Choose a preset",
          "best|paper",
          1,
          1,
          "All settings but the window: the best that we have, or what the paper does",
          [](const Settings& s, const Arguments& a) {
            return with_preset(s, choice<Preset>(a[0]));
          }},
      Row{"reset",
          "Reset settings",
          "[SETTING]",
          0,
          1,
          "Gives a setting, or all of them with window and method, its default value",
          [](const Settings& s, const Arguments& a) {
            return a.empty() ? Settings{} : with_default(s, a[0]);
          }},
  };
  std::vector<Action> actions;
  for (const Row& row : rows) {
    Action action{row.name, row.title, "Method", {}, row.tooltip};
    action.arguments = row.arguments;
    action.needs_recording = false;
    action.run = [row](State& s, const Arguments& arguments) {
      expect_count(row.name, arguments, row.least, row.most);
      change_settings(s, row.changed(s.settings, arguments));
    };
    actions.push_back(std::move(action));
  }
  return actions;
}

void add_settings(std::vector<Action>& table) {
  Action ransac =
      plain("ransac",
            "RANSAC",
            "Method",
            {letter('R')},
            "Rejects outliers by a homography from the reference frame",
            [](State& s) {
              change_settings(s, switched(s.settings, "ransac", !uses_ransac(s.settings)));
            });
  ransac.checked = [](const State& s) { return uses_ransac(s.settings); };
  ransac.needs_recording = false;
  table.push_back(ransac);
  for (Action& action : settings_by_name()) table.push_back(std::move(action));
}

/// A camera that a file tells is not to be replaced by one that is found in the pictures.
void wish_calibration(State& s) {
  if (!s.recording->pictures) throw InputError("calibrate: the recording has no pictures");
  if (s.recording->camera_source == CameraSource::file)
    throw InputError("calibrate: the camera comes from a file and stays");
  s.wishes.calibrate = true;
}

/// The scan is shown, so that one sees what it finds.
void wish_start(State& s) {
  s.view.scan = true;
  s.wishes.find_start = true;
}

}  // namespace

void add_method_actions(std::vector<Action>& table) {
  add_choices_of_method(table);
  add_settings(table);
  table.push_back(plain("compute",
                        "Compute again",
                        "Method",
                        {key(GLFW_KEY_F5, "F5")},
                        "Computes with the same settings, say after Esc",
                        [](State& s) { s.wishes.compute = true; }));
  table.push_back(plain("calibrate",
                        "Calibrate from the plane",
                        "Method",
                        {},
                        "Finds the camera in the pictures of a recording that has no calibration "
                        "(some 30 s) and keeps it for the next time",
                        wish_calibration));
  table.push_back(plain("find-start",
                        "Find a start",
                        "Method",
                        {},
                        "Initializes from everywhere in the recording and goes to the first start "
                        "that is ready, else to the surest",
                        wish_start));
}

}  // namespace gpo
