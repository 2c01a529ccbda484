// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/actions/actions.h"

namespace gpo {

// The rows of `actions()`, one function a menu.
void add_file_actions(std::vector<Action>& table);
void add_edit_actions(std::vector<Action>& table);
void add_view_actions(std::vector<Action>& table);
void add_time_actions(std::vector<Action>& table);
void add_method_actions(std::vector<Action>& table);
void add_help_actions(std::vector<Action>& table);
/// The row that chooses a method.
Action choice_of_method(const MethodChoice& method);

/// Appends rows of one menu or submenu to the table. Each returned row may be completed until the
/// next one is added.
struct MenuRows {
  std::vector<Action>& table;
  const char* menu;
  const char* submenu = "";
  bool needs_recording = true;

  /// The same menu for actions that need no recording.
  MenuRows anytime() const {
    MenuRows rows = *this;
    rows.needs_recording = false;
    return rows;
  }
  Action& add(Action action) const;
  /// Adds an action with arguments, described as in `Action`.
  Action& add(Action action,
              const char* arguments,
              std::function<void(WorkbenchState&, const Arguments&)> run) const;
  /// Adds an action without arguments.
  Action& plain(Action action, std::function<void(WorkbenchState&)> run) const;
  /// Adds a switch: "on" and "off" set it, without an argument it toggles.
  Action& toggle(Action action, const std::function<bool&(WorkbenchState&)>& flag) const;
};

/// The shortcut of a key without modifiers, or with Shift.
Shortcut key(int glfw_key, std::string label, bool shift = false);
/// The shortcut of whatever key types that character.
Shortcut letter(char character);
/// The shortcut of Ctrl and a letter.
Shortcut control(char letter);

}  // namespace gpo
