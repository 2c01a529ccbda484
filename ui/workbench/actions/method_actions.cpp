// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/inspection/settings/setting_values.h"
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"
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
    table.push_back(choice_of_method(methods()[i].key));
    if (i < 9) table.back().shortcuts.push_back(letter(static_cast<char>('1' + i)));
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
    Settings (*changed)(const State&, const Arguments&);
  };
  const std::array rows = {
      Row{"set",
          "Change a setting",
          "SETTING VALUE",
          2,
          2,
          "Gives a setting another value",
          [](const State& s, const Arguments& a) {
            return with_setting(s.document.settings, a[0], a[1], s.methods);
          }},
      Row{"preset",
          "Choose a preset",
          "best|paper",
          1,
          1,
          "All settings but the window: the best that we have, or what the paper does",
          [](const State& s, const Arguments& a) {
            return with_preset(s.document.settings, choice<Preset>(a[0]));
          }},
      Row{"reset",
          "Reset settings",
          "[SETTING]",
          0,
          1,
          "Gives a setting, or all of them with window and method, its default value",
          [](const State& s, const Arguments& a) {
            return a.empty() ? Settings{} : with_default(s.document.settings, a[0]);
          }},
  };
  std::vector<Action> actions;
  for (const Row& row : rows) {
    Action action{row.name, row.title, "Method", {}, row.tooltip};
    action.arguments = row.arguments;
    action.needs_recording = false;
    action.run = [row](State& s, const Arguments& arguments) {
      expect_count(row.name, arguments, row.least, row.most);
      change_settings(s, row.changed(s, arguments));
    };
    actions.push_back(std::move(action));
  }
  return actions;
}

void add_settings(std::vector<Action>& table) {
  Action ransac = plain(
      "ransac",
      "RANSAC",
      "Method",
      {letter('R')},
      "Rejects outliers by a homography from the reference frame",
      [](State& s) {
        change_settings(
            s, switched(s.document.settings, "ransac", !uses_ransac(s.document.settings.options)));
      });
  ransac.checked = [](const State& s) { return uses_ransac(s.document.settings.options); };
  ransac.needs_recording = false;
  table.push_back(ransac);
  for (Action& action : settings_by_name()) table.push_back(std::move(action));
}

/// A camera that a file tells is not to be replaced by one that is found in the pictures.
void request_calibration(State& s) {
  if (!s.document.recording->images) throw InputError("calibrate: the recording has no pictures");
  if (s.document.recording->camera_source == CameraSource::file)
    throw InputError("calibrate: the camera comes from a file and stays");
  s.requests.calibrate = true;
}

/// The scan is shown, so that one sees what it finds.
void request_start(State& s) {
  s.view.toggles.scan = true;
  s.requests.find_start = true;
}

}  // namespace

Action choice_of_method(const MethodChoice& method) {
  Action action = plain("method " + method.key(),
                        method.row().title,
                        "Method",
                        {},
                        method.row().help,
                        [method](State& s) {
                          Settings settings = s.document.settings;
                          settings.options.method = method;
                          change_settings(s, settings);
                        });
  action.checked = [method](const State& s) {
    return s.document.settings.options.method == method;
  };
  action.needs_recording = false;
  return action;
}

void add_method_actions(std::vector<Action>& table) {
  add_choices_of_method(table);
  add_settings(table);
  table.push_back(plain("compute",
                        "Compute again",
                        "Method",
                        {key(GLFW_KEY_F5, "F5")},
                        "Computes with the same settings, say after Esc",
                        [](State& s) { s.requests.compute = true; }));
  table.push_back(plain("calibrate",
                        "Calibrate from the plane",
                        "Method",
                        {},
                        "Finds the camera in the pictures of a recording that has no calibration "
                        "(some 30 s) and keeps it for the next time",
                        request_calibration));
  table.push_back(plain("find-start",
                        "Find a start",
                        "Method",
                        {},
                        "Initializes from everywhere in the recording and goes to the first start "
                        "that is ready, else to the surest",
                        request_start));
}

}  // namespace gpo
