// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/actions.h"
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
  const MenuRows menu = MenuRows{table, "Help"}.anytime();
  Action& palette =
      menu.add({"palette", "All commands", "Finds a command by part of its name and runs it"},
               "[TEXT ...]",
               [](State& s, const Arguments& arguments) {
                 if (s.view.palette && arguments.empty())
                   s.view.palette.reset();
                 else
                   s.view.palette = fmt::format("{}", fmt::join(arguments.words, " "));
               });
  palette.shortcuts = {control('P')};
  palette.checked = [](const State& s) { return s.view.palette.has_value(); };
  palette.opens_field = true;
  Action& help = menu.plain({"help", "Keys", "Lists all keys and their current state"},
                            [](State& s) { s.view.show_help = !s.view.show_help; });
  help.shortcuts = {key(GLFW_KEY_F1, "F1"), letter('?')};
  help.checked = [](const State& s) { return s.view.show_help; };
  menu.plain(
          {"escape", "Cancel or close", "Closes what is open on top, else stops the computation"},
          escape)
      .shortcuts = {key(GLFW_KEY_ESCAPE, "Esc")};
}

}  // namespace gpo
