// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

namespace gpo {

/// What a pane shows beside the current result, and so asks to be computed.
struct PaneNeeds {
  bool compared = false;  ///< the compared results of the window
  bool lengths = false;   ///< ... and of shorter ones
  bool study = false;     ///< the study of the window's normals
};

/// Where in the window a view is.
enum class PaneKind { image, side, columns, drawer, window };

/// One view of the workbench. Tabs, actions, menus, sessions, screenshots and `snapshot --view`
/// read its row; the function that draws it is in the table of ui/panels/panels.cpp.
struct Pane {
  PaneKind kind;
  const char* key;      ///< in scripts, in sessions and on the command line
  const char* title;    ///< for people
  const char* tooltip;  ///< one sentence
  PaneNeeds needs = {};
  bool covers = false;     ///< draws over all of its background
  const char* alias = "";  ///< another name for it that commands accept
};

/// All of them.
std::span<const Pane> panes();
/// The views beside the picture, the first one at the start.
std::span<const Pane> side_panes();
/// The views that are drawn out below picture and side pane.
std::span<const Pane> drawers();

/// By key or alias; null where none has it.
const Pane* find_pane(const std::string& name);
/// The same among those beside the picture, or below.
const Pane* find_side_pane(const std::string& name);
const Pane* find_drawer(const std::string& name);

/// Their keys and aliases.
std::vector<std::string> pane_names();

/// Which views are open.
struct Panes {
  const Pane* side = &side_panes().front();  ///< never null
  const Pane* drawer = nullptr;              ///< null: shut
  bool compare = false;  ///< one column a compared configuration, in place of picture and side pane

  bool operator==(const Panes&) const = default;
};

/// What the open views need, all together.
PaneNeeds needs_of(const Panes& panes);

}  // namespace gpo
