// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// How the window is shared out, and how large its text is.
#include "engine/base/error.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>
#include <cmath>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

constexpr double kLeastZoom = 0.5, kMostZoom = 3, kZoomStep = 0.1;

WindowPart part_in(const Arguments& arguments, WindowPart now) {
  expect_count("maximize", arguments, 0, 1);
  if (arguments.empty()) return now == WindowPart::none ? WindowPart::image : WindowPart::none;
  return choice<WindowPart>(arguments[0] == "image" ? "picture" : arguments[0]);
}

Action maximize_part() {
  Action maximize{
      "maximize",
      "Maximize the picture",
      "View",
      {key(GLFW_KEY_F10, "F10")},
      "Gives one part of the window all of its room, or takes it back; so does a double "
      "click on a tab"};
  maximize.arguments = "[picture|side|drawer|none]";
  maximize.run = [](State& s, const Arguments& arguments) {
    s.view.division.maximized = part_in(arguments, s.view.division.maximized);
  };
  maximize.checked = [](const State& s) { return s.view.division.maximized != WindowPart::none; };
  maximize.value = [](const State& s) { return std::string(to_string(s.view.division.maximized)); };
  maximize.needs_recording = false;
  return maximize;
}

void add_parts(std::vector<Action>& table) {
  table.push_back(maximize_part());
  table.push_back(toggle("column",
                         "Left column",
                         {key(GLFW_KEY_F9, "F9")},
                         "Settings and result",
                         [](State& s) -> bool& { return s.view.division.column; }));
  table.push_back(toggle("timeline",
                         "Time line",
                         {},
                         "Frames, bars and verdicts below everything else",
                         [](State& s) -> bool& { return s.view.division.timeline; }));
  table.push_back(toggle("fullscreen",
                         "Full screen",
                         {key(GLFW_KEY_F11, "F11")},
                         "The window takes the whole screen",
                         [](State& s) -> bool& { return s.view.fullscreen; }));
  table.push_back(
      anytime(plain("reset-layout",
                    "Reset the layout",
                    "View",
                    {},
                    "Column, picture, side pane and drawer share the window as at the start",
                    [](State& s) { s.view.division = {}; })));
}

void set_zoom(State& state, double zoom) {
  state.view.text_zoom =
      std::clamp(std::round(zoom / kZoomStep) * kZoomStep, kLeastZoom, kMostZoom);
}

Shortcut control_key(int glfw_key, std::string label) {
  return {glfw_key, false, true, 0, std::move(label)};
}

void add_text_sizes(std::vector<Action>& table) {
  const auto add = [&](Action action) {
    action.needs_recording = false;
    action.repeats = true;
    table.push_back(std::move(action));
  };
  add(plain("larger",
            "Larger text",
            "View",
            {{GLFW_KEY_EQUAL, true, true, 0, "Ctrl+plus"},
             control_key(GLFW_KEY_EQUAL, "Ctrl+="),
             control_key(GLFW_KEY_KP_ADD, "Ctrl+keypad +")},
            "Text, signs and buttons a tenth larger",
            [](State& s) { set_zoom(s, s.view.text_zoom + kZoomStep); }));
  add(plain("smaller",
            "Smaller text",
            "View",
            {control_key(GLFW_KEY_MINUS, "Ctrl+minus"),
             control_key(GLFW_KEY_KP_SUBTRACT, "Ctrl+keypad -")},
            "Text, signs and buttons a tenth smaller",
            [](State& s) { set_zoom(s, s.view.text_zoom - kZoomStep); }));
  Action size{"text-size",
              "Text size",
              "View",
              {control_key(GLFW_KEY_0, "Ctrl+0"), control_key(GLFW_KEY_KP_0, "Ctrl+keypad 0")},
              "Sets the size of text, signs and buttons [%]; alone: as the screen has it"};
  size.arguments = "[PERCENT]";
  size.run = [](State& s, const Arguments& arguments) {
    expect_count("text-size", arguments, 0, 1);
    set_zoom(s, arguments.empty() ? 1 : number_in("text-size", arguments) / 100);
  };
  size.value = [](const State& s) { return fmt::format("{:.0f} %", 100 * s.view.text_zoom); };
  add(std::move(size));
}

}  // namespace

void add_layout_actions(std::vector<Action>& table) {
  add_submenu(table, "Parts of the window", add_parts);
  add_submenu(table, "Theme and text", add_text_sizes);
}

}  // namespace gpo
