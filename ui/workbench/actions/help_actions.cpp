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
  if (state.view.browse) {
    state.view.browse.reset();
  } else if (state.view.palette) {
    state.view.palette.reset();
  } else if (state.view.show_help) {
    state.view.show_help = false;
  } else {
    state.requests.cancel = true;
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
    if (s.view.palette && arguments.empty())
      s.view.palette.reset();
    else
      s.view.palette = fmt::format("{}", fmt::join(arguments, " "));
  };
  palette.checked = [](const State& s) { return s.view.palette.has_value(); };
  palette.needs_recording = false;
  palette.opens_field = true;
  table.push_back(palette);
  Action help = plain("help",
                      "Keys",
                      "Help",
                      {key(GLFW_KEY_F1, "F1"), letter('?')},
                      "Lists every key and its state",
                      [](State& s) { s.view.show_help = !s.view.show_help; });
  help.checked = [](const State& s) { return s.view.show_help; };
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
