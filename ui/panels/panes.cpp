// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace gpo {

DrawPane image_alone, compare_alone;
DrawPane scene_pane, normals_pane, solver_pane, candidates_pane;
DrawPane curves_drawer, table_drawer, residuals_drawer, timing_drawer, track_drawer, tracks_drawer,
    log_drawer;

namespace {

struct PaneDrawing {
  std::string_view key;  ///< of the pane
  DrawPane* draw;
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

/// What was done to a tab.
enum class TabEvent { none, click, double_click };

/// One name in a row of them; underlined where it is open.
TabEvent tab(const Pane& pane, bool open, const Rectangle& place, float scale) {
  const float padding = 10 * scale;
  const ImVec2 size(ImGui::CalcTextSize(pane.title).x + 2 * padding, place.height);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = hit_area(action_of(pane).c_str(), size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered();
  if (hovered) list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, imgui_color(Role::hovered));
  if (open)
    list.AddRectFilled({at.x, at.y + size.y - std::round(2 * scale)},
                       {at.x + size.x, at.y + size.y},
                       imgui_color(Role::accent));
  const float y = std::round(at.y + (place.height - ImGui::GetTextLineHeight()) / 2);
  list.AddText({std::round(at.x + padding), y},
               imgui_color(open || hovered ? color_of(Role::text) : color_of(Role::text_dim)),
               pane.title);
  tooltip(std::string(pane.tooltip) + "\nDouble click: all of the window, and back");
  const bool twice = hovered && ImGui::IsMouseDoubleClicked(0);
  ImGui::SameLine(0, 0);
  return twice ? TabEvent::double_click : clicked ? TabEvent::click : TabEvent::none;
}

/// A part takes the window, or gives it back.
void maximize(const PanelInput& input, WindowPart part, Commands& commands) {
  const bool back = input.state.view.division.maximized == part;
  push(commands, RunAction{"maximize " + std::string(to_string(back ? WindowPart::none : part))});
}

}  // namespace

DrawPane* draw_function(const Pane& pane) {
  const auto found = std::ranges::find(kDrawings, pane.key, &PaneDrawing::key);
  return found == kDrawings.end() ? nullptr : found->draw;
}

void side_tabs(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const PanelScope panel("side tabs", place, {0, 0});
  for (const Pane& pane : side_panes()) {
    const TabEvent event = tab(pane, input.state.view.panes.side == &pane, place, input.scale);
    if (event != TabEvent::none) push(commands, RunAction{action_of(pane)});
    if (event == TabEvent::double_click) maximize(input, WindowPart::side, commands);
  }
}

void drawer_tabs(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const PanelScope panel("drawer tabs", place, {0, 0});
  for (const Pane& pane : drawers()) {
    const bool open = input.state.view.panes.drawer == &pane;
    const TabEvent event = tab(pane, open, place, input.scale);
    // A drawer shuts when its tab comes up again: not while a second click is still to come.
    if (event == TabEvent::click)
      push(commands, RunAction{open ? "view no-drawer" : action_of(pane)});
    if (event != TabEvent::double_click) continue;
    push(commands, RunAction{action_of(pane)});
    maximize(input, WindowPart::drawer, commands);
  }
}

void side_pane(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  const Pane& open = *input.state.view.panes.side;
  if (open.covers) ImGui::SetNextWindowBgAlpha(0);
  const PanelScope panel("side", place, {0, 0});
  draw_function(open)(input, place, views, commands);
}

void drawer(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  const Pane* open = input.state.view.panes.drawer;
  if (open == nullptr) return;
  const PanelScope panel("drawer", place, {0, 0});
  draw_function (*open)(input, place, views, commands);
}

}  // namespace gpo
