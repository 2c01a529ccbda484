// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/tables.h"

#include "ui/workbench/actions/actions.h"
#include "ui/workbench/state.h"

#include <algorithm>
#include <utility>

namespace gpo {
namespace {

std::vector<Action> make_actions() {
  std::vector<Action> table;
  add_file_actions(table);
  add_edit_actions(table);
  add_view_actions(table);
  add_time_actions(table);
  add_method_actions(table);
  add_help_actions(table);
  return table;
}

}  // namespace

std::span<const Action> actions() {
  static const std::vector<Action> table = make_actions();
  return table;
}

std::vector<Action> all_actions(const WorkbenchState& state) {
  std::vector<Action> all(actions().begin(), actions().end());
  const auto last = std::find_if(all.rbegin(), all.rend(), [](const Action& action) {
    return action.name.starts_with("method ");
  });
  std::vector<Action> own;
  for (const auto& method : state.methods.own())
    own.push_back(choice_of_method(MethodChoice(method)));
  all.insert(last.base(), own.begin(), own.end());
  return all;
}

Action& MenuRows::add(Action action) const {
  action.menu = menu;
  action.submenu = submenu;
  action.needs_recording = needs_recording;
  return table.emplace_back(std::move(action));
}

Action& MenuRows::add(Action action,
                      const char* arguments,
                      std::function<void(WorkbenchState&, const Arguments&)> run) const {
  action.arguments = arguments;
  action.run = std::move(run);
  return add(std::move(action));
}

Action& MenuRows::plain(Action action, std::function<void(WorkbenchState&)> run) const {
  action.run = [run = std::move(run)](WorkbenchState& state, const Arguments&) { run(state); };
  return add(std::move(action));
}

Action& MenuRows::toggle(Action action, const std::function<bool&(WorkbenchState&)>& flag) const {
  action.checked = [flag](const WorkbenchState& s) { return flag(const_cast<WorkbenchState&>(s)); };
  return anytime().add(
      std::move(action), "[on|off]", [flag](WorkbenchState& s, const Arguments& arguments) {
        flag(s) = arguments.on_off(flag(s));
      });
}

Shortcut key(int glfw_key, std::string label, bool shift) {
  return {.key = glfw_key, .shift = shift, .label = std::move(label)};
}

Shortcut letter(char character) {
  const char lower = character >= 'A' && character <= 'Z' ? char(character - 'A' + 'a') : character;
  return {.character = static_cast<char32_t>(lower), .label = std::string(1, character)};
}

Shortcut control(char letter) {
  return {.key = letter, .control = true, .label = std::string("Ctrl+") + letter};
}

}  // namespace gpo
