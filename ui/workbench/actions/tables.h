// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/actions/action.h"

#include <string>
#include <vector>

namespace gpo {

// The rows of `actions()`, one function a menu.
void add_file_actions(std::vector<Action>& table);
void add_edit_actions(std::vector<Action>& table);
void add_view_actions(std::vector<Action>& table);
void add_layout_actions(std::vector<Action>& table);
void add_compare_actions(std::vector<Action>& table);  ///< a part of the views'
void add_time_actions(std::vector<Action>& table);
void add_method_actions(std::vector<Action>& table);
void add_help_actions(std::vector<Action>& table);
/// The row that chooses a method.
Action choice_of_method(const MethodChoice& method);

/// The rows that `add` appends are in a submenu of their menu.
void add_submenu(std::vector<Action>& table, const char* title, void (*add)(std::vector<Action>&));

// How rows are written.

/// A key without modifiers, or with Shift.
Shortcut key(int glfw_key, std::string label, bool shift = false);
/// Whatever key types that character.
Shortcut letter(char character);
/// Ctrl and a letter.
Shortcut control(char letter);

/// A row whose action takes no arguments.
Action plain(std::string name,
             std::string title,
             std::string menu,
             std::vector<Shortcut> shortcuts,
             std::string tooltip,
             std::function<void(WorkbenchState&)> run);

/// The same also where no recording is open.
Action anytime(Action action);

/// Reads the one argument of an action, or the one at `index`, as a number. Throws InputError that
/// names the action.
double number_in(const char* action, const Arguments& arguments, std::size_t index = 0);
int whole_number_in(const char* action, const Arguments& arguments, std::size_t index = 0);
/// Throws InputError where there are fewer or more.
void expect_count(const char* action,
                  const Arguments& arguments,
                  std::size_t least,
                  std::size_t most);
/// "on", "off", or nothing: the other of what it is. Throws InputError.
bool switched(const char* action, const Arguments& arguments, bool now);

/// FACTOR [X Y]: enlarged around a pixel, by default the middle. Throws InputError.
ImageZoom zoom_in(const char* action, const Arguments& arguments, const Camera& camera);

/// A switch of the state; alone it switches, "on" and "off" say how.
Action toggle(std::string name,
              std::string title,
              std::vector<Shortcut> shortcuts,
              std::string tooltip,
              const std::function<bool&(WorkbenchState&)>& flag);

}  // namespace gpo
