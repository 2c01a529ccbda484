// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <tuple>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

/// Off, as it is, enlarged 10 and 100 times, off.
void enlarge_uncertainty(ViewToggles& view) {
  view.uncertainty = view.uncertainty == 0     ? 1
                     : view.uncertainty >= 100 ? 0
                                               : 10 * view.uncertainty;
}

std::string uncertainty_text(const ViewToggles& view) {
  if (view.uncertainty > 1) return "\u00d7" + std::to_string(view.uncertainty);
  return view.uncertainty == 1 ? "on" : "off";
}

/// Without a number the next of those that make sense.
void exaggerate(State& state, const Arguments& arguments) {
  constexpr std::array kTimes = {1, 5, 20, 100};
  expect_count("exaggerate", arguments, 0, 1);
  int& times = state.view.exaggeration;
  const int wanted = arguments.empty() ? times : whole_number_in("exaggerate", arguments);
  const auto found = std::ranges::find(kTimes, wanted);
  if (found == kTimes.end())
    throw InputError(fmt::format("exaggerate: '{}', expected 1, 5, 20 or 100", arguments[0]));
  times = wanted;
  if (arguments.empty()) times = found + 1 == kTimes.end() ? kTimes.front() : *(found + 1);
}

Action exaggeration() {
  Action action{"exaggerate",
                "Exaggerate the cube's error",
                "View",
                {letter('D')},
                "The cube's distance in the picture from the true one, or where there is none from "
                "the first column's, 5, 20 and 100 times as large as it is"};
  action.arguments = "[1|5|20|100]";
  action.value = [](const State& s) {
    return s.view.exaggeration > 1 ? fmt::format("{}\u00d7", s.view.exaggeration) : "off";
  };
  action.checked = [](const State& s) { return s.view.exaggeration > 1; };
  action.needs_recording = false;
  action.run = exaggerate;
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
    return s.model.empty() ? "off" : std::filesystem::path(s.model).filename().string();
  };
  action.checked = [](const State& s) { return !s.model.empty(); };
  action.needs_recording = false;
  action.run = [](State& s, const Arguments& arguments) {
    expect_count("model", arguments, 1, 1);
    const std::string& wanted = arguments[0];
    std::error_code none;
    if (wanted == "off") {
      s.model.clear();
    } else if (wanted == "robot" || std::filesystem::is_regular_file(wanted, none)) {
      s.model = wanted;
    } else {
      throw InputError(fmt::format("model: '{}', expected a file, robot or off", wanted));
    }
  };
  return action;
}

Action point_size() {
  Action action{"point-size", "Size of points", "View", {}, "Of the scene's points [px]"};
  action.arguments = "1..20";
  action.value = [](const State& s) { return fmt::format("{} px", s.view.point_size_px); };
  action.needs_recording = false;
  action.run = [](State& s, const Arguments& arguments) {
    constexpr int kLargest = 20;
    expect_count("point-size", arguments, 1, 1);
    const int wanted = whole_number_in("point-size", arguments);
    if (wanted < 1 || wanted > kLargest)
      throw InputError(fmt::format("point-size: '{}', expected 1 to {}", arguments[0], kLargest));
    s.view.point_size_px = wanted;
  };
  return action;
}

void add_toggles(std::vector<Action>& table) {
  for (const ViewToggle& one : kViewToggles) {
    std::vector<Shortcut> shortcuts;
    if (one.letter != 0) shortcuts.push_back(letter(one.letter));
    table.push_back(toggle(one.key,
                           one.title,
                           std::move(shortcuts),
                           one.tooltip,
                           [shown = one.shown](State& s) -> bool& { return s.view.*shown; }));
  }
  Action uncertainty = plain("uncertainty",
                             "Uncertainty",
                             "View",
                             {letter('U')},
                             "95 % of camera centers and normal in the scene; again: enlarged 10 "
                             "and 100 times, then off",
                             [](State& s) { enlarge_uncertainty(s.view); });
  uncertainty.checked = [](const State& s) { return s.view.uncertainty > 0; };
  uncertainty.value = [](const State& s) { return uncertainty_text(s.view); };
  uncertainty.needs_recording = false;
  table.push_back(uncertainty);
  table.push_back(exaggeration());
  table.push_back(point_size());
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
          s.panes.side = &pane;
          s.panes.compare = false;
          uncover(s.division, WindowPart::side);
        },
        [&pane](const State& s) { return s.panes.side == &pane && !s.panes.compare; }));
  for (const Pane& pane : drawers())
    table.push_back(open_pane(
        pane,
        [&pane](State& s) {
          s.panes.drawer = &pane;
          uncover(s.division, WindowPart::drawer);
        },
        [&pane](const State& s) { return s.panes.drawer == &pane; }));
  Action shut = plain("view no-drawer",
                      "Close the drawer",
                      "View",
                      {},
                      "Picture and side pane take all of the height",
                      [](State& s) { s.panes.drawer = nullptr; });
  shut.needs_recording = false;
  table.push_back(shut);
}

void add_themes(std::vector<Action>& table) {
  for (const auto& [name, title, theme] : {std::tuple{"theme dark", "Dark theme", Theme::dark},
                                           {"theme light", "Light theme", Theme::light}}) {
    Action action = plain(name,
                          title,
                          "View",
                          {},
                          "Colors of the window; those of methods and data stay",
                          [theme = theme](State& s) { s.theme = theme; });
    action.checked = [theme = theme](const State& s) { return s.theme == theme; };
    action.needs_recording = false;
    table.push_back(action);
  }
}

void add_viewpoints(std::vector<Action>& table) {
  for (const ViewpointRow& row : kViewpoints) {
    Action action =
        plain(std::string("viewpoint ") + row.key,
              row.title,
              "View",
              {key(GLFW_KEY_KP_0 + row.keypad - '0', std::string("Keypad ") + row.keypad)},
              row.tooltip,
              [&row](State& s) {
                s.viewpoint = row.viewpoint;
                s.orbit.reset();
              });
    action.checked = [&row](const State& s) { return s.viewpoint == row.viewpoint && !s.orbit; };
    table.push_back(action);
  }
}

void add_colorings(std::vector<Action>& table) {
  for (const ColoringRow& row : kColorings) {
    Action action = plain(
        std::string("color-by ") + row.key, row.title, "View", {}, row.tooltip, [&row](State& s) {
          s.coloring = row.coloring;
        });
    action.checked = [&row](const State& s) { return s.coloring == row.coloring; };
    action.needs_recording = false;
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
                          s.picture_zoom = {};
                          s.compare_zoom.reset();
                          s.normals_zoom = {};
                          s.orbit.reset();
                          s.viewpoint = Viewpoint::oblique;
                        }));
  Action zoom{"zoom", "Zoom the picture", "View", {}, "Shows the picture enlarged around a point"};
  zoom.arguments = "FACTOR [X Y]";
  zoom.run = [](State& s, const Arguments& arguments) {
    expect_count("zoom", arguments, 1, 3);
    s.picture_zoom = zoom_in("zoom", arguments, s.recording->camera);
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
    s.normals_zoom = within_limits(wanted);
  };
  table.push_back(normals);
}

}  // namespace

void add_view_actions(std::vector<Action>& table) {
  add_toggles(table);
  add_panes(table);
  add_compare_actions(table);
  add_cameras(table);
  add_viewpoints(table);
  add_colorings(table);
  add_themes(table);
  add_layout_actions(table);
}

}  // namespace gpo
