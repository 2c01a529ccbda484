// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <functional>
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

/// What follows an action's name, word by word.
using Arguments = std::vector<std::string>;

/// A named action on the workbench. Keys, menus, palette, help window, scripts and tests read the
/// table.
struct Action {
  std::string name;   ///< one or more words: "frame", "select track"
  std::string title;  ///< for people
  std::string menu;   ///< File, Edit, View, Time, Method, Help
  std::vector<Shortcut> shortcuts;
  std::string tooltip;  ///< one sentence
  /// Throws InputError for arguments that it cannot use.
  std::function<void(WorkbenchState&, const Arguments&)> run = {};
  std::string arguments = {};  ///< "N", "FILE"; in brackets where they may be left out
  std::function<std::string(const WorkbenchState&)> value =
      {};  ///< its state, for the help window; else on or off
  std::function<bool(const WorkbenchState&)> checked = {};  ///< null: not a switch
  std::string submenu = {};  ///< of `menu`; empty: it is in the menu itself
  bool needs_recording = true;
  bool repeats = false;      ///< while its key is held
  bool held = false;         ///< run with "on" when its key goes down, with "off" when it comes up
  bool opens_field = false;  ///< which is to have what is typed from then on

  /// Can be run by its name alone.
  bool complete() const { return arguments.empty() || arguments.front() == '['; }
};

}  // namespace gpo
