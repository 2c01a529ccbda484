// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/actions/action.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// The table of all of them, without those that choose a method of the user's own.
std::span<const Action> actions();
/// The table with these.
std::vector<Action> all_actions(const WorkbenchState& state);

/// Null where no action has that name.
const Action* find_action(const std::string& name);
/// The action with a name that stands in the program. Throws std::logic_error where none has it.
const Action& action_named(std::string_view name);

/// The action of a key without Alt or Super; null where it has none.
const Action* action_of_key(int glfw_key, bool shift, bool control = false);
const Action* action_of_character(char32_t character);

bool enabled(const Action& action, const WorkbenchState& state);

/// Whether its first argument is a file or a folder, which one would rather choose than type.
bool takes_a_file(const Action& action);

/// The actions whose name or title has all words of a text, those that begin with it first.
std::vector<Action> find_actions(const std::string& text, const WorkbenchState& state);

/// A line taken apart.
struct ActionCall {
  const Action* action;
  Arguments arguments;
};
/// Of the names that fit the longest counts; nothing where none does.
std::optional<ActionCall> match_line(const std::string& line);

/// Runs one line of a script: an action's name, then its arguments; those with spaces in double
/// quotes. Of the names that fit the longest counts. Throws InputError that says what was found and
/// what is expected.
void run_line(WorkbenchState& state, const std::string& line);

/// The same for people at the window: what is wrong is said in the message line.
void run_action(WorkbenchState& state, const std::string& line);

}  // namespace gpo
