// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

#include <cmath>
#include <string>

namespace gpo {
namespace {

std::string action_of(const Pane& pane) { return std::string("view ") + pane.key; }

/// One name in a row of them; underlined where it is open. Whether it was clicked.
bool tab(const Pane& pane, bool open, const Rectangle& place, float scale) {
  const float padding = 10 * scale;
  const ImVec2 size(ImGui::CalcTextSize(pane.title).x + 2 * padding, place.height);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton(action_of(pane).c_str(), size);
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
  if (!open) tooltip(pane.tooltip);
  ImGui::SameLine(0, 0);
  return clicked;
}

}  // namespace

void side_tabs(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const PanelScope panel("side tabs", place, {0, 0});
  for (const Pane& pane : side_panes())
    if (tab(pane, input.state.panes.side == &pane, place, input.scale))
      push(commands, RunAction{action_of(pane)});
}

void drawer_tabs(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const PanelScope panel("drawer tabs", place, {0, 0});
  for (const Pane& pane : drawers()) {
    const bool open = input.state.panes.drawer == &pane;
    if (tab(pane, open, place, input.scale))
      push(commands, RunAction{open ? "view no-drawer" : action_of(pane)});
  }
}

void side_pane(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  const Pane& open = *input.state.panes.side;
  if (open.covers) ImGui::SetNextWindowBgAlpha(0);
  const PanelScope panel("side", place, {0, 0});
  open.draw(input, place, views, commands);
}

void drawer(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  const Pane* open = input.state.panes.drawer;
  if (open == nullptr) return;
  const PanelScope panel("drawer", place, {0, 0});
  open->draw(input, place, views, commands);
}

}  // namespace gpo
