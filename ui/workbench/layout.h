// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/division.h"

namespace gpo {

/// In screen pixels, from the top left.
struct Rectangle {
  float x = 0, y = 0, width = 0, height = 0;

  float right() const { return x + width; }
  float bottom() const { return y + height; }
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Rectangle&) const = default;
};

/// Where the parts of the window are; they do not overlap and fill it but for the gaps. What is not
/// shown is empty.
struct WindowLayout {
  Rectangle menu;      ///< the whole width
  Rectangle settings;  ///< left column, above
  Rectangle results;   ///< left column, below
  Rectangle views;     ///< picture, side tabs and side pane together: what compare mode takes
  Rectangle image;
  Rectangle side_tabs;    ///< which side pane is open
  Rectangle side;         ///< the side pane
  Rectangle drawer_tabs;  ///< which drawer is open
  Rectangle drawer;       ///< empty where it is shut
  Rectangle timeline;     ///< the whole width
  Rectangle status;       ///< the whole width
};

/// Divides a window of width x height pixels whose text is `scale` times as large as usual. Picture
/// and side pane stand side by side where the space is wide, else one above the other. `scan`: the
/// time line has a strip more.
WindowLayout window_layout(float width,
                           float height,
                           float scale,
                           const Division& division,
                           bool drawer_open,
                           bool scan = false);

/// Of that strip, at scale 1.
inline constexpr float kScanHeight = 22;

/// A line between two parts that can be dragged.
enum class Splitter { column, settings, image, drawer };

/// Where it is, as wide as the gap; empty where there is none.
Rectangle place_of(Splitter splitter, const WindowLayout& layout, float scale);

/// The division with that line through x, y [screen px]; each side keeps what it needs.
Division dragged(const Division& division,
                 Splitter splitter,
                 const WindowLayout& layout,
                 float x,
                 float y,
                 float scale);

/// The division with that line where it comes by itself.
Division automatic(Division division, Splitter splitter);

}  // namespace gpo
