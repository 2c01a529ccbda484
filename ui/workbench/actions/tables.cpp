// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/tables.h"

#include "ui/workbench/actions/actions.h"

#include <utility>

namespace gpo {

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
