// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>
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
  } else if (wanted == "robot" || fs::is_regular_file(wanted, none)) {
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
    return s.document.model.empty() ? "off" : fs::path(s.document.model).filename().string();
  };
  model.checked = [](const State& s) { return !s.document.model.empty(); };
}

/// Restores the layout if another part is maximized and would hide this one.
void uncover(Division& division, WindowPart part) {
  if (division.maximized != part) division.maximized = WindowPart::none;
}

void view_beside(State& state, const Arguments& arguments) {
  Panes& panes = state.view.panes;
  const Pane* pane = find_pane(arguments[0], drawers());
  if (pane == nullptr && arguments[0] != "off") {
    std::vector<std::string> keys;
    for (const Pane& one : drawers()) keys.emplace_back(one.key);
    throw InputError(fmt::format(
        "view-beside: '{}', expected off or one of {}", arguments[0], fmt::join(keys, ", ")));
  }
  if (panes.drawer == nullptr)
    panes.drawer = pane;
  else
    panes.beside = pane == panes.drawer ? nullptr : pane;
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
          if (s.view.panes.beside == &pane) s.view.panes.beside = nullptr;
          uncover(s.view.division, WindowPart::drawer);
        },
        [&pane](const State& s) { return s.view.panes.drawer == &pane; });
  menu.plain({"view no-drawer", "Close the drawer", "Gives image and side pane the full height"},
             [](State& s) { s.view.panes.drawer = s.view.panes.beside = nullptr; });
  menu.add({"view-beside",
            "A second drawer",
            "Shows a second drawer beside the first one; so does Ctrl+click on its tab"},
           "PANE|off",
           view_beside);
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
             s.view.image_zoom = arguments.zoom(*s.document.recording);
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
             if (!arguments.empty()) s.view.compare_zoom = arguments.zoom(*s.document.recording);
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

constexpr double kLeastZoom = 0.5, kMostZoom = 3, kZoomStep = 0.1;

void toggle_maximized(State& state, const Arguments& arguments) {
  WindowPart& part = state.view.division.maximized;
  if (arguments.empty())
    part = part == WindowPart::none ? WindowPart::image : WindowPart::none;
  else
    part = choice<WindowPart>(arguments[0] == "image" ? "picture" : arguments[0]);
}

void add_parts(const MenuRows& menu) {
  Action& part = menu.add({"maximize",
                           "Maximize the image",
                           "Enlarges one part to the whole window, or restores it; so does a "
                           "double click on a tab"},
                          "[picture|side|drawer|none]",
                          toggle_maximized);
  part.shortcuts = {key(GLFW_KEY_F10, "F10")};
  part.checked = [](const State& s) { return s.view.division.maximized != WindowPart::none; };
  part.value = [](const State& s) { return std::string(to_string(s.view.division.maximized)); };
  menu.toggle({"column", "Left column", "Shows settings and result"},
              [](State& s) -> bool& { return s.view.division.column; })
      .shortcuts = {key(GLFW_KEY_F9, "F9")};
  menu.toggle({"timeline", "Time line", "Shows frames, charts and verdicts below everything else"},
              [](State& s) -> bool& { return s.view.division.timeline; });
  menu.toggle({"fullscreen", "Full screen", "Enlarges the window to the whole screen"},
              [](State& s) -> bool& { return s.view.fullscreen; })
      .shortcuts = {key(GLFW_KEY_F11, "F11")};
  menu.plain({"reset-layout",
              "Reset the layout",
              "Restores the default sizes of column, image, side pane and drawer"},
             [](State& s) { s.view.division = {}; });
}

void set_zoom(State& s, double zoom) {
  s.view.text_zoom = std::clamp(std::round(zoom / kZoomStep) * kZoomStep, kLeastZoom, kMostZoom);
}

void add_text_sizes(const MenuRows& menu) {
  const auto control_key = [](int glfw_key, std::string label, bool shift = false) {
    return Shortcut{.key = glfw_key, .shift = shift, .control = true, .label = std::move(label)};
  };
  const auto complete = [](Action& action, std::vector<Shortcut> shortcuts) {
    action.shortcuts = std::move(shortcuts);
    action.repeats = true;
  };
  complete(menu.plain({"larger", "Larger text", "Enlarges text and controls by a tenth"},
                      [](State& s) { set_zoom(s, s.view.text_zoom + kZoomStep); }),
           {control_key('+', "Ctrl+plus"),
            control_key(GLFW_KEY_EQUAL, "", true),  // types + on a US keyboard
            control_key(GLFW_KEY_EQUAL, "Ctrl+="),
            control_key(GLFW_KEY_KP_ADD, "Ctrl+keypad +")});
  complete(menu.plain({"smaller", "Smaller text", "Shrinks text and controls by a tenth"},
                      [](State& s) { set_zoom(s, s.view.text_zoom - kZoomStep); }),
           {control_key(GLFW_KEY_MINUS, "Ctrl+minus"),
            control_key(GLFW_KEY_KP_SUBTRACT, "Ctrl+keypad -")});
  Action& size = menu.add({"text-size",
                           "Text size",
                           "Sets the size of text and controls [%]; without a number, resets it"},
                          "[PERCENT]",
                          [](State& s, const Arguments& arguments) {
                            constexpr double kLeast = 100 * kLeastZoom, kMost = 100 * kMostZoom;
                            const bool reset = arguments.empty();
                            set_zoom(s, reset ? 1 : arguments.number_within(kLeast, kMost) / 100);
                          });
  size.value = [](const State& s) { return fmt::format("{:.0f} %", 100 * s.view.text_zoom); };
  complete(size, {control_key(GLFW_KEY_0, "Ctrl+0"), control_key(GLFW_KEY_KP_0, "Ctrl+keypad 0")});
}

void add_compare_actions(std::vector<Action>& table) {
  const Pane& pane = *find_pane("compare");
  MenuRows{table, "View", "Panes"}
      .toggle({std::string("view ") + pane.key, pane.title, pane.tooltip},
              [](State& s) -> bool& { return s.view.panes.compare; })
      .shortcuts = {letter('C')};
  const MenuRows menu{table, "View", "Compare"};
  add_choice(menu.anytime());
  add_zoom_and_flip(menu);
  add_curves(menu.anytime());
}

}  // namespace

void add_view_actions(std::vector<Action>& table) {
  add_toggles(table);
  add_panes(MenuRows{table, "View", "Panes"}.anytime());
  add_compare_actions(table);
  add_zooms({table, "View", "Zoom"});
  add_viewpoints({table, "View", "Viewpoint"});
  add_choices<Coloring>(MenuRows{table, "View", "Colors and sizes"}.anytime(),
                        "color-by ",
                        [](State& s) -> Coloring& { return s.view.coloring; });
  add_choices<Theme>(MenuRows{table, "View", "Theme and text"}.anytime(),
                     "theme ",
                     [](State& s) -> Theme& { return s.view.theme; });
  add_parts(MenuRows{table, "View", "Parts of the window"}.anytime());
  add_text_sizes(MenuRows{table, "View", "Theme and text"}.anytime());
}

}  // namespace gpo
