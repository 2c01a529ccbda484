// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/views/overlay/overlay.h"
#include "ui/workbench/layout.h"

#include <cstdint>
#include <span>
#include <string>

#include <imgui.h>

namespace gpo {

/// A part of the window, fixed in place, while it lives. What is drawn inside goes there. One that
/// `scrolls` gets a bar where its content is higher than it is.
class PanelScope {
 public:
  PanelScope(const char* name, const Rectangle& place, ImVec2 padding, bool scrolls = false);
  ~PanelScope();
  PanelScope(const PanelScope&) = delete;
  PanelScope& operator=(const PanelScope&) = delete;
};

/// A list in front of everything, in the upper middle of the window, while it lives.
class OverlayScope {
 public:
  OverlayScope(const char* name, const Rectangle& window, float width, float scale);
  ~OverlayScope();
  OverlayScope(const OverlayScope&) = delete;
  OverlayScope& operator=(const OverlayScope&) = delete;
};

/// Up and Down choose among `rows`, the first of which is `first`.
int moved_choice(int chosen, int first, int rows);

/// A part of the window that can be hovered and pressed, drawn by whoever calls; whether it was
/// clicked. At least a pixel each way: Dear ImGui ends the program where a width or height is 0.
bool hit_area(const char* name,
              ImVec2 size,
              ImGuiButtonFlags buttons = ImGuiButtonFlags_MouseButtonLeft);

/// What a part of the window says while it has nothing to show, in its middle: why, and what to do.
void draw_empty(const Rectangle& place, const std::string& text);

/// What a column of a table is called, and what it means.
struct ColumnText {
  const char *title, *meaning;
};
/// The first row of a table, after its columns were set up: dim, with the meanings as tooltips.
/// Columns that are disabled are left out.
void table_header(std::span<const ColumnText> columns);

/// A sign, and a name beside it, in the table's current cell.
void marked_name(Sign sign, std::uint32_t rgb, const std::string& name, float scale);

/// Text in a color of its own.
void colored_text(std::uint32_t rgb, const std::string& text);
void colored_text(Role role, const std::string& text);

/// A small heading in dim capitals.
void heading(const char* text);

/// Shows `text` while the mouse rests on the item drawn last.
void tooltip(const std::string& text);

/// Shows `text` beside the mouse, now.
void show_tooltip(const std::string& text);

/// Text of one line; where it is wider than `width` it ends with "..." and its tooltip is all of
/// it.
void clipped_text(const std::string& text, float width, std::uint32_t rgb);

}  // namespace gpo
