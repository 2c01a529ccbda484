// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void compare_these(State& state, const std::string& list) {
  state.document.compared = parse_configurations(list, state.methods);
}

/// Without settings that only repeat a default of the method.
Configuration shortest(const Configuration& one) { return configuration_of(apply(one, {})); }

auto find_compared(State& state, const Configuration& one) {
  return std::ranges::find(state.document.compared, shortest(one), shortest);
}

void add_compared(State& state, const std::string& list) {
  auto& compared = state.document.compared;
  for (const Configuration& one : parse_configurations(list, state.methods))
    if (find_compared(state, one) == compared.end()) compared.push_back(one);
}

void remove_compared(State& state, const std::string& text) {
  auto& compared = state.document.compared;
  const Configuration removed = parse_configuration(text, state.methods);
  const auto found = find_compared(state, removed);
  if (found == compared.end()) {
    std::vector<std::string> keys;
    for (const Configuration& one : compared) keys.push_back(key_of(one));
    throw InputError(fmt::format("compare remove: '{}' is not compared, expected one of {}",
                                 key_of(removed),
                                 fmt::join(keys, ", ")));
  }
  if (compared.size() == 1)
    throw InputError(
        "compare remove: cannot remove the last one; `compare METHODS` chooses others");
  compared.erase(found);
}

void add_choice(const MenuRows& menu) {
  const auto add =
      [&](Action action, const char* arguments, void (*change)(State&, const std::string&)) {
        menu.add(std::move(action), arguments, [change](State& s, const Arguments& words) {
          change(s, words[0]);
        });
      };
  add({"compare",
       "Compare these",
       "Compares the listed methods, each with its own settings, as in `evaluate --methods`"},
      "METHODS",
      compare_these);
  add({"compare add",
       "Add to the comparison",
       "Adds methods, or one method with other settings, to the comparison"},
      "METHODS",
      add_compared);
  add({"compare remove", "Remove from the comparison", "Removes one method from the comparison"},
      "METHOD",
      remove_compared);
  menu.plain({"compare all",
              "Compare all methods",
              "Compares every method and the ablations of the paper side by side"},
             [](State& s) { compare_these(s, "all"); });
  menu.plain({"compare paper",
              "Compare as in the paper",
              "Compares the four methods of the paper's figure"},
             [](State& s) { compare_these(s, "gpo,pnp_ba,ba,pba"); });
}

void add_zoom_and_flip(const MenuRows& menu) {
  menu.add({"compare zoom",
            "Zoom the comparison",
            "Enlarges all columns around a point; without numbers around the cubes"},
           "[FACTOR [X Y]]",
           [](State& s, const Arguments& arguments) {
             s.view.compare_zoom.reset();
             if (!arguments.empty())
               s.view.compare_zoom = arguments.zoom(s.document.recording->camera);
           });
  Action& flip = menu.toggle(
      {"flip",
       "Flip to the compared result",
       "While held, shows the first other compared result in the image; side by side, swaps the "
       "first two columns"},
      [](State& s) -> bool& { return s.view.flip; });
  flip.shortcuts = {key(GLFW_KEY_X, "X")};
  flip.held = true;
}

void switch_curve(State& state, const Arguments& arguments) {
  const std::string key = key_of(shortest(parse_configuration(arguments[0], state.methods)));
  const auto found = std::ranges::find(state.view.hidden_curves, key);
  const bool shown = found == state.view.hidden_curves.end();
  const bool show = arguments.on_off(shown, 1);
  if (show && !shown) state.view.hidden_curves.erase(found);
  if (!show && shown) state.view.hidden_curves.push_back(key);
}

void add_curves(const MenuRows& menu) {
  menu.add({"curve", "Toggle a curve", "Shows or hides the curves of a method"},
           "METHOD [on|off]",
           switch_curve);
  menu.plain({"close-results",
              "Close the opened results",
              "Shows the curves of this recording again instead of those of a results.csv"},
             [](State& s) {
               s.results.experiment.reset();
               s.results.experiment_name.clear();
             });
}

}  // namespace

void add_compare_actions(std::vector<Action>& table) {
  const Pane& pane = *find_pane("compare");
  MenuRows{table, "View", "Open"}
      .toggle({std::string("view ") + pane.key, pane.title, pane.tooltip},
              [](State& s) -> bool& { return s.view.panes.compare; })
      .shortcuts = {letter('C')};
  const MenuRows menu{table, "View", "Compare"};
  add_choice(menu.anytime());
  add_zoom_and_flip(menu);
  add_curves(menu.anytime());
}

}  // namespace gpo
