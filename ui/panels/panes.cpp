// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes.h"

#include "ui/context/gui.h"
#include "ui/look/palette.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/actions.h"

#include <cmath>

namespace gpo {
namespace {

using Pane = void (*)(const PanelInput&, const Rectangle&, Views&, Commands&);

constexpr Pane kSidePanes[] = {scene_pane, normals_pane, solver_pane, candidates_pane};
constexpr Pane kDrawers[] = {
    curves_drawer, table_drawer, residuals_drawer, timing_drawer, track_drawer, log_drawer};

/// One name in a row of them; underlined where it is open. Whether it was clicked.
bool tab(const Action& action, bool open, const Rectangle& place, float scale) {
  const float padding = 10 * scale;
  const ImVec2 size(ImGui::CalcTextSize(action.title.c_str()).x + 2 * padding, place.height);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton(action.name.c_str(), size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered();
  if (hovered)
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, imgui_color(palette::kHovered));
  if (open)
    list.AddRectFilled({at.x, at.y + size.y - std::round(2 * scale)},
                       {at.x + size.x, at.y + size.y},
                       imgui_color(palette::kAccent));
  const float y = std::round(at.y + (place.height - ImGui::GetTextLineHeight()) / 2);
  list.AddText({std::round(at.x + padding), y},
               imgui_color(open || hovered ? palette::kText : palette::kTextDim),
               action.title.c_str());
  if (!open) tooltip(action.tooltip);
  ImGui::SameLine(0, 0);
  return clicked;
}

template <Choice E>
const Action& action_of(E pane) {
  return *find_action(std::string("view ") + to_string(pane));
}

}  // namespace

void side_tabs(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const PanelScope panel("side tabs", place, {0, 0});
  for (std::size_t i = 0; i < std::size(kSidePanes); ++i) {
    const auto pane = static_cast<SidePane>(i);
    const Action& action = action_of(pane);
    if (tab(action, input.state.panes.side == pane, place, input.scale))
      push(commands, RunAction{action.name});
  }
}

void drawer_tabs(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const PanelScope panel("drawer tabs", place, {0, 0});
  for (std::size_t i = 0; i < std::size(kDrawers); ++i) {
    const auto one = static_cast<Drawer>(i);
    const Action& action = action_of(one);
    const bool open = input.state.panes.drawer == one;
    if (tab(action, open, place, input.scale))
      push(commands, RunAction{open ? "view no-drawer" : action.name});
  }
}

void side_pane(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  if (input.state.panes.side == SidePane::scene)
    ImGui::SetNextWindowBgAlpha(0);  // all of it is drawn over
  const PanelScope panel("side", place, {0, 0});
  kSidePanes[static_cast<std::size_t>(input.state.panes.side)](input, place, views, commands);
}

void drawer(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  const PanelScope panel("drawer", place, {0, 0});
  kDrawers[static_cast<std::size_t>(*input.state.panes.drawer)](input, place, views, commands);
}

}  // namespace gpo
