// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>
#include <cmath>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

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

void set_zoom(State& state, double zoom) {
  state.view.text_zoom =
      std::clamp(std::round(zoom / kZoomStep) * kZoomStep, kLeastZoom, kMostZoom);
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
           {control_key(GLFW_KEY_EQUAL, "Ctrl+plus", true),
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
                            set_zoom(s, arguments.empty() ? 1 : arguments.number() / 100);
                          });
  size.value = [](const State& s) { return fmt::format("{:.0f} %", 100 * s.view.text_zoom); };
  complete(size, {control_key(GLFW_KEY_0, "Ctrl+0"), control_key(GLFW_KEY_KP_0, "Ctrl+keypad 0")});
}

}  // namespace

void add_layout_actions(std::vector<Action>& table) {
  add_parts(MenuRows{table, "View", "Parts of the window"}.anytime());
  add_text_sizes(MenuRows{table, "View", "Theme and text"}.anytime());
}

}  // namespace gpo
