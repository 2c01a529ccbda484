// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

namespace gpo {

/// The results that a pane shows besides the current one.
struct PaneNeeds {
  bool compared = false;  ///< the compared results of the window
  bool lengths = false;   ///< and those of shorter windows
  bool study = false;     ///< the study of the normals of the window
};

/// The part of the window in which a view is.
enum class PaneKind { image, side, columns, drawer, window };

/// One view of the workbench. Tabs, actions, menus, sessions, screenshots and `snapshot --view`
/// read its row; the function that draws it is in the table of ui/panels/panels.cpp.
struct Pane {
  PaneKind kind;
  const char* key;      ///< in scripts, in sessions and on the command line
  const char* title;    ///< for people
  const char* tooltip;  ///< one sentence
  PaneNeeds needs = {};
  bool covers = false;     ///< covers its whole background
  const char* alias = "";  ///< another name that commands accept
};

std::span<const Pane> panes();
/// The views next to the image; the first one is open at the start.
std::span<const Pane> side_panes();
/// The views below image and side pane.
std::span<const Pane> drawers();

/// Finds a view by key or alias; null if there is none.
const Pane* find_pane(const std::string& name);
const Pane* find_side_pane(const std::string& name);
const Pane* find_drawer(const std::string& name);

/// Keys and aliases of all views.
std::vector<std::string> pane_names();

/// Which views are open.
struct Panes {
  const Pane* side = &side_panes().front();  ///< never null
  const Pane* drawer = nullptr;              ///< null: closed
  bool compare =
      false;  ///< one column for each compared configuration instead of image and side pane

  bool operator==(const Panes&) const = default;
};

/// The needs of all open views together.
PaneNeeds needs_of(const Panes& panes);

}  // namespace gpo
