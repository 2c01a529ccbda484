// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

std::vector<Shortcut> letters(char one) {
  return one == 0 ? std::vector<Shortcut>{} : std::vector{letter(one)};
}

/// Throws InputError for an argument that the row does not allow.
int number_after(const ViewNumber& row, int now, const Arguments& arguments) {
  if (arguments.empty()) {
    const auto next = std::ranges::upper_bound(row.steps, now);
    return next == row.steps.end() ? row.steps.front() : *next;
  }
  const int wanted = whole_number_in(row.action, arguments);
  const bool allowed = row.has_steps() ? std::ranges::count(row.steps, wanted) > 0
                                       : wanted >= row.least && wanted <= row.most;
  if (allowed) return wanted;
  throw InputError(
      row.has_steps()
          ? fmt::format("{}: '{}', expected {}, {}, {} or {}",
                        row.action,
                        arguments[0],
                        row.steps[0],
                        row.steps[1],
                        row.steps[2],
                        row.steps[3])
          : fmt::format(
                "{}: '{}', expected {} to {}", row.action, arguments[0], row.least, row.most));
}

Action number(const ViewNumber& row) {
  Action action{row.action, row.title, "View", letters(row.letter), row.tooltip};
  action.arguments = row.arguments;
  action.submenu = row.submenu;
  action.needs_recording = false;
  action.value = [&row](const State& s) { return row.text(s.view.toggles.*row.value); };
  if (row.has_steps())
    action.checked = [&row](const State& s) { return s.view.toggles.*row.value > row.off; };
  action.run = [&row](State& s, const Arguments& arguments) {
    expect_count(row.action, arguments, row.has_steps() ? 0 : 1, *row.arguments == 0 ? 0 : 1);
    s.view.toggles.*row.value = number_after(row, s.view.toggles.*row.value, arguments);
  };
  return action;
}

/// robot, a file of the user's, or off.
Action model() {
  Action action{"model",
                "A model in the cube's place",
                "View",
                {},
                "An own model, or the robot that the program carries with it, stands on the plane; "
                "off: the cube again"};
  action.arguments = "FILE (.obj, .ply, .gltf, .glb)|robot|off";
  action.value = [](const State& s) {
    return s.document.model.empty() ? "off"
                                    : std::filesystem::path(s.document.model).filename().string();
  };
  action.checked = [](const State& s) { return !s.document.model.empty(); };
  action.submenu = kCubeMenu;
  action.needs_recording = false;
  action.run = [](State& s, const Arguments& arguments) {
    expect_count("model", arguments, 1, 1);
    const std::string& wanted = arguments[0];
    std::error_code none;
    if (wanted == "off") {
      s.document.model.clear();
    } else if (wanted == "robot" || std::filesystem::is_regular_file(wanted, none)) {
      s.document.model = wanted;
    } else {
      throw InputError(fmt::format("model: '{}', expected a file, robot or off", wanted));
    }
  };
  return action;
}

void add_toggles(std::vector<Action>& table) {
  for (const ViewToggle& one : kViewToggles) {
    table.push_back(
        toggle(one.key,
               one.title,
               letters(one.letter),
               one.tooltip,
               [shown = one.shown](State& s) -> bool& { return s.view.toggles.*shown; }));
    table.back().submenu = one.submenu;
  }
  for (const ViewNumber& one : kViewNumbers) table.push_back(number(one));
  table.push_back(model());
}

Action open_pane(const Pane& pane,
                 std::function<void(State&)> open,
                 std::function<bool(const State&)> is_open) {
  Action action =
      plain(std::string("view ") + pane.key, pane.title, "View", {}, pane.tooltip, std::move(open));
  action.checked = std::move(is_open);
  action.needs_recording = false;
  return action;
}

/// What is asked for is not to stay behind what has the whole window.
void uncover(Division& division, WindowPart part) {
  if (division.maximized != part) division.maximized = WindowPart::none;
}

void add_panes(std::vector<Action>& table) {
  for (const Pane& pane : side_panes())
    table.push_back(open_pane(
        pane,
        [&pane](State& s) {
          s.view.panes.side = &pane;
          s.view.panes.compare = false;
          uncover(s.view.division, WindowPart::side);
        },
        [&pane](const State& s) { return s.view.panes.side == &pane && !s.view.panes.compare; }));
  for (const Pane& pane : drawers())
    table.push_back(open_pane(
        pane,
        [&pane](State& s) {
          s.view.panes.drawer = &pane;
          uncover(s.view.division, WindowPart::drawer);
        },
        [&pane](const State& s) { return s.view.panes.drawer == &pane; }));
  table.push_back(anytime(plain("view no-drawer",
                                "Close the drawer",
                                "View",
                                {},
                                "Picture and side pane take all of the height",
                                [](State& s) { s.view.panes.drawer = nullptr; })));
}

/// An action a value of what `chosen` returns.
template <class T>
void add_choices(std::vector<Action>& table, const std::string& name, T& (*chosen)(State&)) {
  for (const ChoiceRow<T>& row : choice_rows(T{})) {
    const auto choose = [&row, chosen](State& s) { chosen(s) = row.value; };
    table.push_back(anytime(plain(name + row.key, row.title, "View", {}, row.tooltip, choose)));
    table.back().checked = [&row, chosen](const State& s) {
      return chosen(const_cast<State&>(s)) == row.value;
    };
  }
}

void add_themes(std::vector<Action>& table) {
  add_choices<Theme>(table, "theme ", [](State& s) -> Theme& { return s.view.theme; });
}

void add_colorings(std::vector<Action>& table) {
  add_choices<Coloring>(table, "color-by ", [](State& s) -> Coloring& { return s.view.coloring; });
}

void add_viewpoints(std::vector<Action>& table) {
  for (const auto& row : kViewpoints) {
    Action action =
        plain(std::string("viewpoint ") + row.key,
              row.title,
              "View",
              {key(GLFW_KEY_KP_0 + row.keypad - '0', std::string("Keypad ") + row.keypad)},
              row.tooltip,
              [&row](State& s) {
                s.view.viewpoint = row.value;
                s.view.orbit.reset();
              });
    action.checked = [&row](const State& s) {
      return s.view.viewpoint == row.value && !s.view.orbit;
    };
    table.push_back(action);
  }
}

void add_cameras(std::vector<Action>& table) {
  table.push_back(plain("fit",
                        "Fit view",
                        "View",
                        {letter('F')},
                        "Shows all of the picture, of the scene and of the normals",
                        [](State& s) {
                          s.view.image_zoom = {};
                          s.view.compare_zoom.reset();
                          s.view.normals_zoom = {};
                          s.view.orbit.reset();
                          s.view.viewpoint = Viewpoint::oblique;
                        }));
  Action zoom{"zoom", "Zoom the picture", "View", {}, "Shows the picture enlarged around a point"};
  zoom.arguments = "FACTOR [X Y]";
  zoom.run = [](State& s, const Arguments& arguments) {
    expect_count("zoom", arguments, 1, 3);
    s.view.image_zoom = zoom_in("zoom", arguments, s.document.recording->camera);
  };
  table.push_back(zoom);
  Action normals{"zoom-normals",
                 "Zoom the normals",
                 "View",
                 {},
                 "Shows the disc of normals enlarged around one of so much tilt to the right and "
                 "down [deg]"};
  normals.arguments = "FACTOR [RIGHT DOWN]";
  normals.run = [](State& s, const Arguments& arguments) {
    expect_count("zoom-normals", arguments, 1, 3);
    NormalsZoom wanted;
    wanted.factor = number_in("zoom-normals", arguments);
    if (arguments.size() > 1)
      wanted.center = {number_in("zoom-normals", arguments, 1) / 90,
                       number_in("zoom-normals", arguments, 2) / 90};
    s.view.normals_zoom = within_limits(wanted);
  };
  table.push_back(normals);
}

}  // namespace

void add_view_actions(std::vector<Action>& table) {
  add_toggles(table);
  add_submenu(table, "Open", add_panes);
  add_compare_actions(table);
  add_submenu(table, "Zoom", add_cameras);
  add_submenu(table, "Look at the scene", add_viewpoints);
  add_submenu(table, "Colors and sizes", add_colorings);
  add_submenu(table, "Theme and text", add_themes);
  add_layout_actions(table);
}

}  // namespace gpo
