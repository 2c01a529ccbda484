// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

constexpr const char* kOfThePaper = "gpo,pnp_ba,ba,pba";

void compare_these(State& state, const std::string& list) {
  state.document.compared = parse_configurations(list, state.methods);
}

/// Without what only repeats a default of the method.
Configuration shortest(const Configuration& one) { return configuration_of(apply(one, {})); }

/// The compared one that comes to the same by default.
auto find_compared(State& state, const Configuration& one) {
  return std::ranges::find(state.document.compared, shortest(one), shortest);
}

void compare_also(State& state, const std::string& list) {
  auto& compared = state.document.compared;
  for (const Configuration& one : parse_configurations(list, state.methods))
    if (find_compared(state, one) == compared.end()) compared.push_back(one);
}

void compare_no_longer(State& state, const std::string& text) {
  auto& compared = state.document.compared;
  const Configuration removed = parse_configuration(text, state.methods);
  const auto found = find_compared(state, removed);
  if (found == compared.end()) {
    std::vector<std::string> keys;
    for (const Configuration& one : compared) keys.push_back(key_of(one));
    throw InputError(fmt::format("compare remove: '{}' is not among the compared ones: {}",
                                 key_of(removed),
                                 fmt::join(keys, ", ")));
  }
  if (compared.size() == 1)
    throw InputError("compare remove: the last one stays; `compare METHODS` chooses others");
  compared.erase(found);
}

/// An action whose one argument is a list of configurations, or one.
Action of_configurations(std::string name,
                         std::string title,
                         std::string tooltip,
                         std::string arguments,
                         void (*run)(State&, const std::string&)) {
  Action action{std::move(name), std::move(title), "View", {}, std::move(tooltip)};
  action.arguments = std::move(arguments);
  action.needs_recording = false;
  action.run = [run, name = action.name](State& s, const Arguments& arguments) {
    expect_count(name.c_str(), arguments, 1, 1);
    run(s, arguments[0]);
  };
  return action;
}

void add_choice(std::vector<Action>& table) {
  table.push_back(of_configurations(
      "compare",
      "Compare these",
      "Chooses what is compared: methods with commas, each with settings that differ, as "
      "`evaluate --methods` reads them",
      "METHODS",
      compare_these));
  table.push_back(of_configurations("compare add",
                                    "Compare also",
                                    "Puts methods, or settings of one, beside what is compared",
                                    "METHODS",
                                    compare_also));
  table.push_back(of_configurations("compare remove",
                                    "Remove from the comparison",
                                    "Takes one away from what is compared",
                                    "METHOD",
                                    compare_no_longer));
  struct Preset {
    const char *name, *title, *tooltip, *list;
  };
  for (const Preset& preset : {Preset{"compare all",
                                      "Compare all methods",
                                      "Every method, and the paper's ablations, side by side",
                                      "all"},
                               Preset{"compare paper",
                                      "Compare as the paper",
                                      "The four methods of the paper's figure",
                                      kOfThePaper}}) {
    Action action = plain(
        preset.name, preset.title, "View", {}, preset.tooltip, [list = preset.list](State& s) {
          compare_these(s, list);
        });
    action.needs_recording = false;
    table.push_back(action);
  }
}

void add_patches(std::vector<Action>& table) {
  Action zoom{"compare zoom",
              "Zoom the comparison",
              "View",
              {},
              "Shows all columns enlarged around a point; without numbers around the cubes"};
  zoom.arguments = "[FACTOR [X Y]]";
  zoom.run = [](State& s, const Arguments& arguments) {
    s.view.compare_zoom.reset();
    if (!arguments.empty())
      s.view.compare_zoom = zoom_in("compare zoom", arguments, s.document.recording->camera);
  };
  table.push_back(zoom);
  Action flip = toggle("flip",
                       "Flip to the compared result",
                       {key(GLFW_KEY_X, "X")},
                       "While held: the picture shows the first compared other result, in place; "
                       "side by side the first two change places",
                       [](State& s) -> bool& { return s.view.flip; });
  flip.held = true;
  table.push_back(flip);
}

void switch_curve(State& state, const Arguments& arguments) {
  expect_count("curve", arguments, 1, 2);
  const std::string key = key_of(shortest(parse_configuration(arguments[0], state.methods)));
  const auto found = std::ranges::find(state.view.hidden_curves, key);
  const bool shown = found == state.view.hidden_curves.end();
  const bool show = switched("curve", {arguments.begin() + 1, arguments.end()}, shown);
  if (show && !shown) state.view.hidden_curves.erase(found);
  if (!show && shown) state.view.hidden_curves.push_back(key);
}

void add_curves(std::vector<Action>& table) {
  Action curve{"curve", "A curve", "View", {}, "Shows or hides a method's curves"};
  curve.arguments = "METHOD [on|off]";
  curve.needs_recording = false;
  curve.run = switch_curve;
  table.push_back(curve);
  table.push_back(
      anytime(plain("close-results",
                    "Close the opened results",
                    "View",
                    {},
                    "The curves show this recording again, no longer those of a results.csv",
                    [](State& s) {
                      s.results.experiment.reset();
                      s.results.experiment_name.clear();
                    })));
}

}  // namespace

void add_compare_actions(std::vector<Action>& table) {
  const Pane& pane = *find_pane("compare");
  table.push_back(toggle(std::string("view ") + pane.key,
                         pane.title,
                         {letter('C')},
                         pane.tooltip,
                         [](State& s) -> bool& { return s.view.panes.compare; }));
  table.back().submenu = "Open";
  add_submenu(table, "Compare", add_choice);
  add_submenu(table, "Compare", add_patches);
  add_submenu(table, "Compare", add_curves);
}

}  // namespace gpo
