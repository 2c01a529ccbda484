// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Tabs of the panes beside the image, and of the drawers.
#include "ui/context/imgui_versions.h"
#include "ui/panels/panels.h"

#include <algorithm>

namespace gpo {
namespace {

std::string action_of(const Pane& pane) { return std::string("view ") + pane.key; }

float tab_width(const char* title, float scale) {
  return ImGui::CalcTextSize(title).x + 20 * scale;
}

/// Returns whether it was clicked. It is underlined if its pane is open.
bool tab_item(const char* name, const char* title, bool open, float height, float scale) {
  const ImVec2 size(tab_width(title, scale), height);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 end(at.x + size.x, at.y + size.y);
  const bool clicked = hit_area(name, size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered();
  if (hovered) list.AddRectFilled(at, end, imgui_color(Role::hovered));
  if (open)
    list.AddRectFilled({at.x, end.y - std::round(2 * scale)}, end, imgui_color(Role::accent));
  const float y = std::round(at.y + (height - ImGui::GetTextLineHeight()) / 2);
  list.AddText({std::round(at.x + 10 * scale), y},
               imgui_color(open || hovered ? Role::text : Role::text_dim),
               title);
  return clicked;
}

/// Shows a tooltip of the last item until it is clicked, and again when the mouse comes back.
void tooltip_until_click(const std::string& text) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID clicked = last_item();
  if (ImGui::IsItemActive()) storage.SetBool(clicked, true);
  if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) storage.SetBool(clicked, false);
  if (!storage.GetBool(clicked)) tooltip(text);
}

bool tab(const Pane& pane, bool open, float height, float scale) {
  const bool clicked = tab_item(action_of(pane).c_str(), pane.title, open, height, scale);
  tooltip_until_click(
      std::string(pane.tooltip) + "\nDouble click to maximize or restore" +
      (pane.kind == PaneKind::drawer ? ". Ctrl+click to show it beside another" : ""));
  return clicked;
}

constexpr const char* kMoreTabs = "\u25b6";

/// Returns how many panes have room for their tabs, beside the button for the others.
std::size_t fitting_tabs(std::span<const Pane> panes, float width, float scale) {
  float needed = 0;
  for (const Pane& pane : panes) needed += tab_width(pane.title, scale);
  if (needed <= width) return panes.size();
  float left = width - tab_width(kMoreTabs, scale);
  std::size_t fit = 0;
  while (fit < panes.size() && left >= tab_width(panes[fit].title, scale))
    left -= tab_width(panes[fit++].title, scale);
  return fit;
}

/// Draws a button that lists the panes without a tab.
void more_tabs(const PanelContext& ui,
               std::span<const Pane> panes,
               const Pane* open,
               float height) {
  if (panes.empty()) return;
  const bool shown = std::ranges::any_of(panes, [&](const Pane& pane) { return &pane == open; });
  if (tab_item("more", kMoreTabs, shown, height, ui.scale)) ImGui::OpenPopup("more tabs");
  tooltip_until_click("Lists the panes whose tabs have no room here");
  if (!ImGui::BeginPopup("more tabs")) return;
  for (const Pane& pane : panes)
    if (ImGui::MenuItem(pane.title, nullptr, &pane == open))
      push(ui.commands, RunAction{action_of(pane)});
  ImGui::EndPopup();
}

/// A click on an open drawer's tab closes it; with Ctrl opens it beside the other one.
std::string line_of_tab(const Pane& pane, const Panes& shown) {
  if (pane.kind == PaneKind::side) return action_of(pane);
  if (shown.beside == &pane) return "view-beside off";
  if (ImGui::GetIO().KeyCtrl && shown.drawer != nullptr)
    return std::string("view-beside ") + pane.key;
  if (shown.drawer != &pane) return action_of(pane);
  return shown.beside == nullptr ? "view no-drawer" : action_of(*shown.beside);
}

/// Draws the tabs of panes, which a double click maximizes. `open`: null if none is.
void draw_tabs(const PanelContext& ui,
               const Rectangle& place,
               std::span<const Pane> panes,
               const Pane* open,
               WindowPart part) {
  const Panes& shown = ui.state.view.panes;
  const std::size_t fit = fitting_tabs(panes, place.width, ui.scale);
  for (const Pane& pane : panes.first(fit)) {
    const bool is_open = open == &pane || shown.beside == &pane;
    const bool clicked = tab(pane, is_open, place.height, ui.scale);
    const bool twice = is_item_double_clicked();
    ImGui::SameLine(0, 0);
    // A click closes the open drawer; the second press of a double click opens it again.
    if (clicked && !twice) push(ui.commands, RunAction{line_of_tab(pane, shown)});
    if (!twice) continue;
    push(ui.commands, RunAction{action_of(pane)});
    const WindowPart wanted = ui.state.view.division.maximized == part ? WindowPart::none : part;
    push(ui.commands, RunAction{std::string("maximize ") + to_string(wanted)});
  }
  more_tabs(ui, panes.subspan(fit), open, place.height);
}

}  // namespace

void side_tabs(const PanelContext& ui, const Rectangle& place) {
  const PanelScope scope("side tabs", place, {0, 0});
  draw_tabs(ui, place, side_panes(), ui.state.view.panes.side, WindowPart::side);
}

void drawer_tabs(const PanelContext& ui, const Rectangle& place) {
  const PanelScope scope("drawer tabs", place, {0, 0});
  draw_tabs(ui, place, drawers(), ui.state.view.panes.drawer, WindowPart::drawer);
}

}  // namespace gpo
