// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/state.h"

#include <imgui.h>

namespace gpo {

enum class PanelKind {
  fixed,
  scrolling,  ///< has a scroll bar if its content is higher
  over        ///< transparent and in front of other panels
};

/// A rectangular part of the window. Widgets drawn during its lifetime go there.
class PanelScope {
 public:
  PanelScope(const char* name,
             const Rectangle& place,
             ImVec2 padding,
             PanelKind kind = PanelKind::fixed);
  ~PanelScope();
  PanelScope(const PanelScope&) = delete;
  PanelScope& operator=(const PanelScope&) = delete;
};

/// Adds an invisible item for the mouse and returns whether it was clicked. It measures at least
/// 1 px: Dear ImGui aborts on a width or height of 0.
bool hit_area(const char* name,
              ImVec2 size,
              ImGuiButtonFlags buttons = ImGuiButtonFlags_MouseButtonLeft);

/// The same at a place of the screen.
bool hit_area_at(const char* name, const Rectangle& place);

/// The mouse pointer [screen px].
Eigen::Vector2d mouse_px();
/// Returns whether the mouse is where its button went down, so that releasing it is a click.
bool is_click(float scale, int button = ImGuiMouseButton_Left);
/// Returns the zoom factor that the wheel requests over the last item; 1 if none.
double wheel_zoom();
/// Returns how far the mouse drags the last item in this frame [px].
Eigen::Vector2d drag_px();
bool is_item_double_clicked();

/// Fills `place` with a text that says why there is no content, and what to do.
void draw_empty(const Rectangle& place, const std::string& text);

struct ColumnText {
  const char *title, *meaning;
};
/// Draws the first row of a table whose columns are set up: dim titles, meanings as tooltips.
void table_header(std::span<const ColumnText> columns);
/// Sets up the columns with a header row that does not scroll.
void frozen_header(std::span<const ColumnText> columns);

/// Draws a sign and a name beside it into the current table cell.
void marked_name(Sign sign, std::uint32_t rgb, const std::string& name, float scale);
/// Draws a sign as high as a line of text at the cursor.
void sign_at_cursor(Sign sign, std::uint32_t rgb);

void colored_text(std::uint32_t rgb, const std::string& text);
void colored_text(Role role, const std::string& text);

/// Returns the color of a message; `note` is for those of the lowest severity.
Role role_of(Severity severity, Role note);

/// A small heading in dim capitals.
void heading(const char* text);

/// Shows `text` while the mouse hovers over the last item.
void tooltip(const std::string& text);
/// Shows `text` beside the mouse in this frame.
void show_tooltip(const std::string& text);

/// Draws one line of text; if it is wider than `width`, it ends with "..." and has a tooltip.
void clipped_text(const std::string& text, float width, std::uint32_t rgb);

/// Fills the bound framebuffer.
void clear_framebuffer(std::uint32_t rgb);

}  // namespace gpo
