// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

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

/// One view: tabs, actions, menus, sessions, screenshots and `snapshot --view` read its row.
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
const Pane* find_pane(const std::string& name, std::span<const Pane> among = panes());

std::vector<std::string> pane_names();

struct Panes {
  const Pane* side = &side_panes().front();  ///< never null
  const Pane* drawer = nullptr;              ///< null: closed
  const Pane* beside = nullptr;              ///< a second drawer at its right; null: none
  bool compare = false;                      ///< columns instead of image and side pane

  bool operator==(const Panes&) const = default;
};

PaneNeeds needs_of(const Panes& panes);

enum class WindowPart { none, image, side, drawer };

template <>
struct ChoiceKeys<WindowPart> : NamedKeys<"part", "none", "picture", "side", "drawer"> {};

/// How the user has divided the window; 0: the default. Lengths are at scale 1 [px].
struct Division {
  double column_px = 0;     ///< width of the left column
  double settings_px = 0;   ///< height of its upper part
  double image_share = 0;   ///< part of the views' width, or of their height if stacked
  double drawer_share = 0;  ///< part of the views' height
  bool column = true;       ///< shown
  bool timeline = true;     ///< shown
  WindowPart maximized = WindowPart::none;

  bool operator==(const Division&) const = default;
};

/// In screen pixels, from the top left.
struct Rectangle {
  float x = 0, y = 0, width = 0, height = 0;

  float right() const { return x + width; }
  float bottom() const { return y + height; }
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Rectangle&) const = default;
};

/// The parts of the window. They fill it except for gaps and do not overlap; hidden ones are empty.
struct WindowLayout {
  Rectangle menu;      ///< full width
  Rectangle verdict;   ///< left column, on top
  Rectangle settings;  ///< left column, below the verdict
  Rectangle results;   ///< left column, below
  Rectangle banner;    ///< above the views: why the window failed; empty if it did not
  Rectangle views;     ///< image, side tabs and side pane together; the columns in compare mode
  Rectangle image;
  Rectangle side_tabs;  ///< titles of the side panes
  Rectangle side;
  Rectangle drawer_tabs;  ///< titles of the drawers
  Rectangle drawer;
  Rectangle beside;    ///< the second drawer
  Rectangle timeline;  ///< full width
  Rectangle status;    ///< full width
};

struct LayoutInput {
  float width, height;  ///< window size [px]
  float scale = 1;      ///< text scale
  Division division = {};
  bool drawer_open = false;
  bool scan = false;          ///< the time line has the strip of the scan, too
  bool beside_open = false;   ///< a second drawer beside the first one
  bool failed = false;        ///< the views have a banner
  float verdict_height = 0;   ///< height of the content [px]; 0: unknown
  float settings_height = 0;  ///< height of the content [px]; 0: unknown
};

/// Divides a window. Image and side pane are side by side in a wide space, else stacked.
WindowLayout window_layout(const LayoutInput& input);

/// Height of the strip of the scan at scale 1 [px].
inline constexpr float kScanHeight = 22;

/// A line between two parts that can be dragged.
enum class Splitter { column, settings, image, drawer };

/// The splitter's line, as wide as the gap; empty if it is not there.
Rectangle place_of(Splitter splitter, const WindowLayout& layout, float scale);

struct DragPoint {
  float x, y;  ///< [screen px]
};
/// The division with the splitter dragged to a point, within limits for the parts on both sides.
Division dragged(
    Division division, Splitter splitter, const WindowLayout& layout, DragPoint to, float scale);

/// The division with the splitter at its default place.
Division automatic(Division division, Splitter splitter);

}  // namespace gpo
