// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/view_options.h"
#include "ui/panels/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace gpo {

DrawPanel scene_pane, normals_pane, solver_pane, candidates_pane;
DrawPanel curves_drawer, table_drawer, residuals_drawer, timing_drawer, track_drawer, tracks_drawer,
    log_drawer;

namespace {

// Image and comparison without controls, for screenshots, snapshots and movies.

void image_alone(const PanelContext& ui, const Rectangle& place) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto other = flipped_result(ui.state);
  const Inspection* inspection = other ? other->inspection.get() : ui.inspection();
  const Inspection waiting =
      inspection ? Inspection{} : nothing_to_show(ui.state.document.recording);
  const int frame = update_image(ui);
  draw_image_view(list,
                  screen_rect(place),
                  inspection ? *inspection : waiting,
                  frame,
                  shown_image(ui.views),
                  {},
                  view_options(other ? showing(ui.state, *other) : ui.state, ui.views));
  if (other) draw_flip_label(list, screen_rect(place), *other);
}

void compare_alone(const PanelContext& ui, const Rectangle& place) {
  const int frame = update_image(ui);
  ViewOptions options = view_options(ui.state, ui.views);
  options.compare_zoom = ui.state.view.compare_zoom;
  draw_compare_view(*ImGui::GetBackgroundDrawList(),
                    screen_rect(place),
                    compare_columns(compared_results(ui.state)),
                    *ui.state.document.recording,
                    frame,
                    shown_image(ui.views),
                    options);
}

struct PaneDrawing {
  std::string_view key;
  DrawPanel* draw;
};

constexpr auto kDrawings = std::to_array<PaneDrawing>({{"image", image_alone},
                                                       {"scene", scene_pane},
                                                       {"normals", normals_pane},
                                                       {"solver", solver_pane},
                                                       {"candidates", candidates_pane},
                                                       {"compare", compare_alone},
                                                       {"curves", curves_drawer},
                                                       {"table", table_drawer},
                                                       {"residuals", residuals_drawer},
                                                       {"timing", timing_drawer},
                                                       {"track", track_drawer},
                                                       {"tracks", tracks_drawer},
                                                       {"log", log_drawer}});

std::string action_of(const Pane& pane) { return std::string("view ") + pane.key; }

enum class TabEvent { none, click, double_click };

/// Draws a tab, underlined if its pane is open.
TabEvent tab(const Pane& pane, bool open, float height, float scale) {
  const float padding = 10 * scale;
  const ImVec2 size(ImGui::CalcTextSize(pane.title).x + 2 * padding, height);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 end(at.x + size.x, at.y + size.y);
  const bool clicked = hit_area(action_of(pane).c_str(), size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered();
  if (hovered) list.AddRectFilled(at, end, imgui_color(Role::hovered));
  if (open)
    list.AddRectFilled({at.x, end.y - std::round(2 * scale)}, end, imgui_color(Role::accent));
  const float y = std::round(at.y + (height - ImGui::GetTextLineHeight()) / 2);
  list.AddText({std::round(at.x + padding), y},
               imgui_color(open || hovered ? Role::text : Role::text_dim),
               pane.title);
  tooltip(std::string(pane.tooltip) + "\nDouble click: maximize, and restore");
  const bool twice = is_item_double_clicked();
  ImGui::SameLine(0, 0);
  return twice ? TabEvent::double_click : clicked ? TabEvent::click : TabEvent::none;
}

void toggle_maximized(const PanelContext& ui, WindowPart part) {
  if (ui.state.view.division.maximized == part) part = WindowPart::none;
  push(ui.commands, RunAction{"maximize " + std::string(to_string(part))});
}

}  // namespace

DrawPanel* draw_function(const Pane& pane) {
  const auto found = std::ranges::find(kDrawings, pane.key, &PaneDrawing::key);
  return found == kDrawings.end() ? nullptr : found->draw;
}

void side_tabs(const PanelContext& ui, const Rectangle& place) {
  const PanelScope scope("side tabs", place, {0, 0});
  for (const Pane& pane : side_panes()) {
    const TabEvent event = tab(pane, ui.state.view.panes.side == &pane, place.height, ui.scale);
    if (event != TabEvent::none) push(ui.commands, RunAction{action_of(pane)});
    if (event == TabEvent::double_click) toggle_maximized(ui, WindowPart::side);
  }
}

void drawer_tabs(const PanelContext& ui, const Rectangle& place) {
  const PanelScope scope("drawer tabs", place, {0, 0});
  for (const Pane& pane : drawers()) {
    const bool open = ui.state.view.panes.drawer == &pane;
    const TabEvent event = tab(pane, open, place.height, ui.scale);
    // A click closes the open drawer; the second press of a double click opens it again.
    if (event == TabEvent::click)
      push(ui.commands, RunAction{open ? "view no-drawer" : action_of(pane)});
    if (event != TabEvent::double_click) continue;
    push(ui.commands, RunAction{action_of(pane)});
    toggle_maximized(ui, WindowPart::drawer);
  }
}

void side_pane(const PanelContext& ui, const Rectangle& place) {
  const Pane& open = *ui.state.view.panes.side;
  if (open.covers) ImGui::SetNextWindowBgAlpha(0);
  const PanelScope scope("side", place, {0, 0});
  draw_function(open)(ui, place);
}

void drawer(const PanelContext& ui, const Rectangle& place) {
  const Pane* open = ui.state.view.panes.drawer;
  if (open == nullptr) return;
  const PanelScope scope("drawer", place, {0, 0});
  draw_function (*open)(ui, place);
}

}  // namespace gpo
