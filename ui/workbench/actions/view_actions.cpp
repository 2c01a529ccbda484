// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

std::vector<Shortcut> letters(char one) {
  return one == 0 ? std::vector<Shortcut>{} : std::vector{letter(one)};
}

/// Throws InputError for an argument that the row does not allow.
int next_number(const ViewNumber& row, int now, const Arguments& arguments) {
  if (arguments.empty()) {
    const auto next = std::ranges::upper_bound(row.steps, now);
    return next == row.steps.end() ? row.steps.front() : *next;
  }
  const int wanted = arguments.whole_number();
  const bool allowed = row.has_steps() ? std::ranges::count(row.steps, wanted) > 0
                                       : wanted >= row.least && wanted <= row.most;
  if (allowed) return wanted;
  const std::string expected = row.has_steps()
                                   ? fmt::format("one of {}", fmt::join(row.steps, ", "))
                                   : fmt::format("{} to {}", row.least, row.most);
  throw InputError(fmt::format("{}: '{}', expected {}", row.action, arguments[0], expected));
}

void add_number(std::vector<Action>& table, const ViewNumber& row) {
  Action& action = MenuRows{table, "View", row.submenu}.anytime().add(
      {row.action, row.title, row.tooltip},
      row.arguments,
      [&row](State& s, const Arguments& arguments) {
        s.view.toggles.*row.value = next_number(row, s.view.toggles.*row.value, arguments);
      });
  action.shortcuts = letters(row.letter);
  action.value = [&row](const State& s) { return row.text(s.view.toggles.*row.value); };
  if (row.has_steps())
    action.checked = [&row](const State& s) { return s.view.toggles.*row.value > row.off; };
}

void set_model(State& state, const Arguments& arguments) {
  const std::string& wanted = arguments[0];
  std::error_code none;
  if (wanted == "off") {
    state.document.model.clear();
  } else if (wanted == "robot" || std::filesystem::is_regular_file(wanted, none)) {
    state.document.model = wanted;
  } else {
    throw InputError(fmt::format("model: '{}', expected a file, robot or off", wanted));
  }
}

void add_toggles(std::vector<Action>& table) {
  for (const ViewToggle& one : kViewToggles)
    MenuRows{table, "View", one.submenu}
        .toggle({one.key, one.title, one.tooltip},
                [shown = one.shown](State& s) -> bool& { return s.view.toggles.*shown; })
        .shortcuts = letters(one.letter);
  for (const ViewNumber& one : kViewNumbers) add_number(table, one);
  Action& model = MenuRows{table, "View", kCubeMenu}.anytime().add(
      {"model",
       "Model instead of the cube",
       "Shows the built-in robot or a model file (.obj, .ply, .gltf, .glb) on the plane"},
      "FILE|robot|off",
      set_model);
  model.value = [](const State& s) {
    return s.document.model.empty() ? "off"
                                    : std::filesystem::path(s.document.model).filename().string();
  };
  model.checked = [](const State& s) { return !s.document.model.empty(); };
}

/// Restores the layout if another part is maximized and would hide this one.
void uncover(Division& division, WindowPart part) {
  if (division.maximized != part) division.maximized = WindowPart::none;
}

void add_panes(const MenuRows& menu) {
  const auto add = [&](const Pane& pane, auto open, auto is_open) {
    menu.plain({std::string("view ") + pane.key, pane.title, pane.tooltip}, std::move(open))
        .checked = std::move(is_open);
  };
  for (const Pane& pane : side_panes())
    add(
        pane,
        [&pane](State& s) {
          s.view.panes.side = &pane;
          s.view.panes.compare = false;
          uncover(s.view.division, WindowPart::side);
        },
        [&pane](const State& s) { return s.view.panes.side == &pane && !s.view.panes.compare; });
  for (const Pane& pane : drawers())
    add(
        pane,
        [&pane](State& s) {
          s.view.panes.drawer = &pane;
          uncover(s.view.division, WindowPart::drawer);
        },
        [&pane](const State& s) { return s.view.panes.drawer == &pane; });
  menu.plain({"view no-drawer", "Close the drawer", "Gives image and side pane the full height"},
             [](State& s) { s.view.panes.drawer = nullptr; });
}

/// Adds one action for each value of the choice that `chosen` returns.
template <class T>
void add_choices(const MenuRows& menu, const std::string& name, T& (*chosen)(State&)) {
  for (const ChoiceRow<T>& row : choice_rows(T{})) {
    Action& action = menu.plain({name + row.key, row.title, row.tooltip},
                                [&row, chosen](State& s) { chosen(s) = row.value; });
    action.checked = [&row, chosen](const State& s) {
      return chosen(const_cast<State&>(s)) == row.value;
    };
  }
}

void add_viewpoints(const MenuRows& menu) {
  for (const auto& row : kViewpoints) {
    Action& action =
        menu.plain({std::string("viewpoint ") + row.key, row.title, row.tooltip}, [&row](State& s) {
          s.view.viewpoint = row.value;
          s.view.orbit.reset();
        });
    action.shortcuts = {key(GLFW_KEY_KP_0 + row.keypad - '0', std::string("Keypad ") + row.keypad)};
    action.checked = [&row](const State& s) {
      return s.view.viewpoint == row.value && !s.view.orbit;
    };
  }
}

void add_zooms(const MenuRows& menu) {
  menu.plain({"fit", "Fit view", "Shows the whole image, scene and disc of normals"},
             [](State& s) {
               s.view.image_zoom = {};
               s.view.compare_zoom.reset();
               s.view.normals_zoom = {};
               s.view.orbit.reset();
               s.view.viewpoint = Viewpoint::oblique;
             })
      .shortcuts = {letter('F')};
  menu.add({"zoom", "Zoom the image", "Enlarges the image around a point"},
           "FACTOR [X Y]",
           [](State& s, const Arguments& arguments) {
             s.view.image_zoom = arguments.zoom(s.document.recording->camera);
           });
  menu.add({"zoom-normals",
            "Zoom the normals",
            "Enlarges the disc of normals around a normal, given by its tilt to the right and "
            "down [deg]"},
           "FACTOR [RIGHT DOWN]",
           [](State& s, const Arguments& arguments) {
             NormalsZoom wanted;
             wanted.factor = arguments.number();
             if (arguments.size() > 1)
               wanted.center = {arguments.number(1) / 90, arguments.number(2) / 90};
             s.view.normals_zoom = within_limits(wanted);
           });
}

}  // namespace

void add_view_actions(std::vector<Action>& table) {
  add_toggles(table);
  add_panes(MenuRows{table, "View", "Open"}.anytime());
  add_compare_actions(table);
  add_zooms({table, "View", "Zoom"});
  add_viewpoints({table, "View", "Viewpoint"});
  add_choices<Coloring>(MenuRows{table, "View", "Colors and sizes"}.anytime(),
                        "color-by ",
                        [](State& s) -> Coloring& { return s.view.coloring; });
  add_choices<Theme>(MenuRows{table, "View", "Theme and text"}.anytime(),
                     "theme ",
                     [](State& s) -> Theme& { return s.view.theme; });
  add_layout_actions(table);
}

}  // namespace gpo
