// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/tables.h"

#include <utility>

#include <GLFW/glfw3.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void add_settings(const MenuRows& menu) {
  Action& ransac =
      menu.plain({"ransac", "RANSAC", "Rejects outliers by a homography from the reference frame"},
                 [](State& s) {
                   const Settings& now = s.document.settings;
                   change_settings(s, switched(now, "ransac", !uses_ransac(now.options)));
                 });
  ransac.shortcuts = {letter('R')};
  ransac.checked = [](const State& s) { return uses_ransac(s.document.settings.options); };
  const auto add = [&](Action action,
                       const char* arguments,
                       Settings (*changed)(const State&, const Arguments&)) {
    menu.add(std::move(action), arguments, [changed](State& s, const Arguments& a) {
      change_settings(s, changed(s, a));
    });
  };
  add({"set", "Change a setting", "Gives a setting another value"},
      "SETTING VALUE",
      [](const State& s, const Arguments& a) {
        return with_setting(s.document.settings, a[0], a[1], s.methods);
      });
  add({"preset",
       "Choose a preset",
       "Changes all settings but the window to the best known ones or to those of the paper"},
      "best|paper",
      [](const State& s, const Arguments& a) {
        return with_preset(s.document.settings, choice<Preset>(a[0]));
      });
  add({"reset",
       "Reset settings",
       "Resets one setting, or all of them including window and method, to its default"},
      "[SETTING]",
      [](const State& s, const Arguments& a) {
        return a.empty() ? Settings{} : with_default(s.document.settings, a[0]);
      });
}

/// A camera that a file describes is not replaced by one estimated from the images.
void request_calibration(State& s) {
  if (!s.document.recording->images) throw InputError("calibrate: the recording has no images");
  if (s.document.recording->camera_source == CameraSource::file)
    throw InputError("calibrate: the recording has a calibration file, which takes precedence");
  s.requests.calibrate = true;
}

/// Shows the scan, too, so that its progress can be watched.
void request_start(State& s) {
  s.view.toggles.scan = true;
  s.requests.find_start = true;
}

}  // namespace

Action choice_of_method(const MethodChoice& method) {
  std::vector<Action> table;
  Action& action = MenuRows{table, "Method"}.anytime().plain(
      {"method " + method.key(), method.row().title, method.row().help}, [method](State& s) {
        Settings settings = s.document.settings;
        settings.options.method = method;
        change_settings(s, settings);
      });
  action.checked = [method](const State& s) {
    return s.document.settings.options.method == method;
  };
  return action;
}

void add_method_actions(std::vector<Action>& table) {
  for (std::size_t i = 0; i < methods().size(); ++i) {
    table.push_back(choice_of_method(methods()[i].key));
    if (i < 9) table.back().shortcuts.push_back(letter(static_cast<char>('1' + i)));
  }
  const MenuRows menu{table, "Method"};
  add_settings(menu.anytime());
  menu.plain({"compute", "Compute again", "Computes again with the same settings"},
             [](State& s) { s.requests.compute = true; })
      .shortcuts = {key(GLFW_KEY_F5, "F5")};
  menu.plain({"calibrate",
              "Calibrate from the plane",
              "Estimates the camera of a recording without calibration from its images (about "
              "30 s) and saves it for the next time"},
             request_calibration);
  menu.plain({"find-start",
              "Find a start",
              "Initializes from start frames all over the recording and goes to the first one that "
              "is ready, else to the one with the lowest uncertainty"},
             request_start);
}

}  // namespace gpo
