// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/tables.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void escape(State& state) {
  if (state.browse) {
    state.browse.reset();
  } else if (state.palette) {
    state.palette.reset();
  } else if (state.show_help) {
    state.show_help = false;
  } else {
    state.wishes.cancel = true;
  }
}

}  // namespace

void add_help_actions(std::vector<Action>& table) {
  Action palette{"palette",
                 "All commands",
                 "Help",
                 {control('P')},
                 "Finds a command by a part of its name and runs it"};
  palette.arguments = "[TEXT]";
  palette.run = [](State& s, const Arguments& arguments) {
    if (s.palette && arguments.empty())
      s.palette.reset();
    else
      s.palette = fmt::format("{}", fmt::join(arguments, " "));
  };
  palette.checked = [](const State& s) { return s.palette.has_value(); };
  palette.needs_recording = false;
  palette.opens_field = true;
  table.push_back(palette);
  Action help = plain("help",
                      "Keys",
                      "Help",
                      {key(GLFW_KEY_F1, "F1"), letter('?')},
                      "Lists every key and its state",
                      [](State& s) { s.show_help = !s.show_help; });
  help.checked = [](const State& s) { return s.show_help; };
  help.needs_recording = false;
  table.push_back(help);
  table.push_back(anytime(plain("escape",
                                "Cancel, or close what is open",
                                "Help",
                                {key(GLFW_KEY_ESCAPE, "Esc")},
                                "Closes the list of keys, else stops the computation",
                                escape)));
}

}  // namespace gpo
