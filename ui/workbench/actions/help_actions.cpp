// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/actions.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

void go_on_tour(WorkbenchState& state, const Arguments& arguments) {
  constexpr int kSteps = 3;
  int& step = state.view.tour;
  if (arguments.empty()) {
    step = (step + 1) % (kSteps + 1);
  } else if (arguments[0] == "off") {
    step = 0;
  } else {
    const int wanted = arguments.whole_number();
    if (wanted < 1 || wanted > kSteps)
      throw InputError(fmt::format("tour: '{}', expected 1 to {} or off", arguments[0], kSteps));
    step = wanted;
  }
}

void add_help_pages(const MenuRows& menu) {
  struct Row {
    HelpPage page;
    const char *name, *title, *tooltip;
    std::vector<Shortcut> shortcuts = {};
  };
  for (const Row& row :
       {Row{HelpPage::keys,
            "help",
            "Keys",
            "Lists all keys and their current state",
            {key(GLFW_KEY_F1, "F1"), letter('?')}},
        Row{HelpPage::glossary, "glossary", "Glossary", "Explains the terms of the window"},
        Row{HelpPage::manual, "manual", "Manual", "Explains the parts of the window and their use"},
        Row{HelpPage::findings,
            "findings",
            "Findings",
            "Lists what is checked, and which findings may be ignored"},
        Row{HelpPage::about, "about", "About", "Shows the version and how it was built"}}) {
    const auto is_open = [page = row.page](const WorkbenchState& s) {
      return s.view.show_help && s.view.help_page == page;
    };
    Action& action = menu.plain({row.name, row.title, row.tooltip},
                                [page = row.page, is_open](WorkbenchState& s) {
                                  s.view.show_help = !is_open(s);
                                  s.view.help_page = page;
                                });
    action.shortcuts = row.shortcuts;
    action.checked = is_open;
  }
  menu.add(
      {"tour", "Take the tour", "Explains the window in three steps; without a number goes on"},
      "[1|2|3|off]",
      go_on_tour);
}

void escape(WorkbenchState& state) {
  if (state.view.browse) return state.view.browse.reset();
  if (state.view.sources) return state.view.sources.reset();
  if (state.view.palette) return state.view.palette.reset();
  if (state.view.tour > 0 && !state.view.show_help) {
    state.view.tour = 0;
    return;
  }
  bool& changed = state.view.show_help ? state.view.show_help : state.requests.cancel;
  changed = !state.view.show_help;
}

}  // namespace

void add_help_actions(std::vector<Action>& table) {
  const MenuRows menu = MenuRows{table, "Help"}.anytime();
  Action& palette =
      menu.add({"palette", "All commands", "Finds a command by part of its name and runs it"},
               "[TEXT ...]",
               [](WorkbenchState& s, const Arguments& arguments) {
                 if (s.view.palette && arguments.empty())
                   s.view.palette.reset();
                 else
                   s.view.palette = fmt::format("{}", fmt::join(arguments.words, " "));
               });
  palette.shortcuts = {control('P')};
  palette.checked = [](const WorkbenchState& s) { return s.view.palette.has_value(); };
  palette.opens_field = true;
  add_help_pages(menu);
  menu.plain({"escape",
              "Cancel or close",
              "Closes what is open on top, else stops the computation, clears the selection or "
              "closes the drawer"},
             escape)
      .shortcuts = {key(GLFW_KEY_ESCAPE, "Esc")};
}

}  // namespace gpo
