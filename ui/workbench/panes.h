// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/commands.h"

#include <span>
#include <string>

namespace gpo {

struct PanelInput;
struct Rectangle;
struct Views;

/// Draws a pane into the part of the window that it fills, which is a panel already. One file each,
/// in ui/panels.
using DrawPane = void(const PanelInput&, const Rectangle&, Views&, Commands&);

/// What a pane shows beside the current result, and so asks to be computed.
struct PaneNeeds {
  bool compared = false;  ///< the compared results of the window
  bool lengths = false;   ///< ... and of shorter ones
  bool study = false;     ///< the study of the window's normals
};

/// One of the views beside the picture (a side pane) or below (a drawer): a row of their tables,
/// which the tabs, the actions, sessions and snapshots read.
struct Pane {
  const char* key;      ///< in scripts and sessions, and after "view " the name of its action
  const char* title;    ///< for people
  const char* tooltip;  ///< one sentence
  DrawPane* draw;
  PaneNeeds needs = {};
  bool covers = false;  ///< draws over all of its background
};

/// What stands beside the picture, the first one at the start.
std::span<const Pane> side_panes();
/// What is drawn out below picture and side pane.
std::span<const Pane> drawers();

/// Null where none has that key.
const Pane* find_side_pane(const std::string& key);
const Pane* find_drawer(const std::string& key);

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
