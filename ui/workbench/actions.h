// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/workbench.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A key of the keyboard, or, where `character` is not 0, whatever key types that character: so "["
/// and "?" are found on every layout.
struct Shortcut {
  int key = 0;  ///< GLFW_KEY_*
  bool shift = false;
  bool control = false;
  char32_t character = 0;  ///< lower case
  std::string label = {};  ///< for people
};

/// A named action on the workbench. Keys, menus, the help window and the tests read the table.
struct Action {
  std::string name;  ///< in commands and scripts
  std::string title;
  std::string menu;  ///< File, View, Time, Method, Help
  std::vector<Shortcut> shortcuts;
  std::string tooltip;  ///< one sentence
  std::function<void(WorkbenchState&)> run = {};
  std::function<std::string(const WorkbenchState&)> value =
      {};  ///< its state, for the help window; else on or off
  std::function<bool(const WorkbenchState&)> checked = {};  ///< null: not a switch
  bool needs_recording = true;
  bool repeats = false;  ///< while its key is held
};

std::span<const Action> actions();

/// Null where no action has that name.
const Action* find_action(const std::string& name);

/// The action of a key without Alt or Super; null where it has none.
const Action* action_of_key(int glfw_key, bool shift, bool control = false);
const Action* action_of_character(char32_t character);

/// Runs the action named so; where it needs a recording and none is open, a message says that.
void run_action(WorkbenchState& state, const std::string& name);

bool enabled(const Action& action, const WorkbenchState& state);

}  // namespace gpo
